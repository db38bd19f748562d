// SPDX-License-Identifier: BSD-3-Clause
// Checksums by which damaged files are found.
#pragma once

#include <cstdint>
#include <string_view>

namespace photonav {

/// CRC-32 (ITU-T V.42) of bytes.
/// @param before checksum of the bytes before these
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

}  // namespace photonav
