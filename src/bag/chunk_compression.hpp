// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace photonav {

inline constexpr std::uint32_t kLargestChunk = 1U << 28U;  ///< [bytes]; rosbag's own are 0.8 MB

/// Decompresses a chunk of a bag.
/// @param compression "none", "bz2" or "lz4"
/// @param size expected size of the result [bytes]
/// @throws std::runtime_error for another compression, and for a chunk that is damaged or too large
std::vector<std::uint8_t> uncompressed(const std::string& compression,
                                       std::span<const std::uint8_t> compressed,
                                       std::uint32_t size);

}  // namespace photonav
