// SPDX-License-Identifier: BSD-3-Clause
// Base64 (RFC 4648, with padding): how binary arrays and pictures travel inside JSON.
#pragma once

#include <string>
#include <string_view>

namespace photonav {

std::string base64Encode(std::string_view bytes);

/// @throws std::invalid_argument if `text` is not base64
std::string base64Decode(std::string_view text);

}  // namespace photonav
