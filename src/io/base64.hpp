// SPDX-License-Identifier: BSD-3-Clause
// Base64 (RFC 4648, with padding): binary arrays and pictures inside JSON.
#pragma once

#include <string>
#include <string_view>

namespace photonav {

std::string base64Encode(std::string_view bytes);

/// @throws std::invalid_argument for a character or a length that no encoded text has
std::string base64Decode(std::string_view text);

}  // namespace photonav
