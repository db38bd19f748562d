// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <span>

#include "io/image_bytes.hpp"

namespace photonav {

/// Whether nothing gets to standard error while an image is decoded. libpng, libjpeg and OpenCV
/// write there what is wrong with an image, without its name. For programs that say it themselves.
inline std::atomic<bool> quietDecoders{false};

/// Decodes an image whose size is wanted: PNG, JPEG, BMP, PGM or PPM.
/// @param flags   those of cv::imdecode
/// @param wanted  is asked with the size that the header declares, before anything is decoded; what
///                it throws passes through
/// @returns an empty matrix if the bytes are no image, are damaged, or `wanted` returned false
cv::Mat decodedImage(std::span<const std::uint8_t> encoded, int flags,
                     const std::function<bool(const ImageSize&)>& wanted);

}  // namespace photonav
