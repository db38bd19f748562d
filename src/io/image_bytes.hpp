// SPDX-License-Identifier: BSD-3-Clause
// Checks of encoded images before they are decoded. Without these checks, libpng and libjpeg would
// report damage on standard error only, and fill missing parts with grey.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace photonav {

/// The bytes of a file; empty for a file that is empty.
/// @throws InputError when it cannot be opened
std::vector<std::uint8_t> readBytes(const std::string& file);

/// The bytes that a decoder needs. Of a PNG: the chunks that make up the picture, if all checksums
/// are right and the last chunk is present. Of a JPEG: all bytes, if its end marker is present. Of
/// other formats: all bytes. Empty if the image is empty, cut short or damaged.
/// @param rewritten where they are if they are not those of `encoded`
std::span<const std::uint8_t> soundImage(std::span<const std::uint8_t> encoded,
                                         std::vector<std::uint8_t>& rewritten);

struct ImageSize {
    std::uint64_t width, height;  ///< [pixels]
};

/// The size that the header of an encoded image declares. It is checked before decoding, because a
/// file of 2 MB may hold an image of 2 GB.
/// @returns nothing for other formats than PNG, JPEG, BMP, PGM and PPM, and without a whole header
std::optional<ImageSize> declaredSize(std::span<const std::uint8_t> encoded);

}  // namespace photonav
