// SPDX-License-Identifier: BSD-3-Clause
// Base64 (RFC 4648, with padding): binary arrays and pictures inside JSON.
#pragma once

#include <string>
#include <string_view>

namespace photonav {

/// Encodes bytes as Base64.
std::string base64Encode(std::string_view bytes);

/// Decodes Base64 to bytes.
/// @throws std::invalid_argument for an invalid character or length
std::string base64Decode(std::string_view text);

}  // namespace photonav
