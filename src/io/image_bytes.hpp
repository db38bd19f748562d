// SPDX-License-Identifier: BSD-3-Clause
// Encoded images, checked before a decoder sees them. libpng and libjpeg write what they find wrong
// to standard error, and pad what is missing with grey.
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

/// What a decoder needs of an encoded image: of a PNG the chunks that make up the picture, each
/// with a good checksum and the last one there; of a JPEG, all of it, when it has its end; other
/// formats as they are. Empty when the image is empty, cut short or damaged.
std::vector<std::uint8_t> soundImage(std::span<const std::uint8_t> encoded);

struct ImageSize {
    std::uint64_t width, height;  ///< [pixels]
};

/// The size that the header of an encoded image declares, so that nothing is decoded that is not
/// wanted: a file of 2 MB may hold an image of 2 GB.
/// @returns nothing for other formats than PNG, JPEG, BMP, PGM and PPM, and without a whole header
std::optional<ImageSize> declaredSize(std::span<const std::uint8_t> encoded);

}  // namespace photonav
