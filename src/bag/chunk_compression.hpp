// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace photonav {

/// A chunk of a bag as it was before it was compressed.
/// @param compression "none", "bz2" or "lz4"
/// @param size that it must have
/// @throws std::runtime_error for another compression, and for what is damaged or too large
std::vector<std::uint8_t> uncompressed(const std::string& compression,
                                       std::span<const std::uint8_t> compressed,
                                       std::uint32_t size);

}  // namespace photonav
