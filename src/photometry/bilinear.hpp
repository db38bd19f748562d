// SPDX-License-Identifier: BSD-3-Clause
// Bilinear interpolation of images.
#pragma once

#include <cstddef>

#include "geometry/types.hpp"

namespace photonav {

/// Value of an image at (u, v) [pixels], interpolated bilinearly between the four pixels around
/// that point. All four must be in the image: 0 <= u < width - 1, 0 <= v < height - 1.
inline float bilinear(const ImageF& image, double u, double v) {
    const auto column = static_cast<int>(u);
    const auto row = static_cast<int>(v);
    const auto a = static_cast<float>(u - column);
    const auto b = static_cast<float>(v - row);
    const float* p = image.bitmap + std::ptrdiff_t(row) * image.getWidth() + column;
    const float* q = p + image.getWidth();
    const float above = p[0] + a * (p[1] - p[0]);
    const float below = q[0] + a * (q[1] - q[0]);
    return above + b * (below - above);
}

}  // namespace photonav
