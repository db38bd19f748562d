// SPDX-License-Identifier: BSD-3-Clause
// Images at half the size, and half of that.
#pragma once

#include <vector>

#include "geometry/camera.hpp"

namespace photonav {

inline constexpr unsigned kMinSide = 12;  ///< pixels: smaller images get no level

/// The camera of halved(): pixel (u, v) covers pixels 2u, 2u + 1, 2v, 2v + 1; an odd last row or
/// column is dropped.
Camera halved(const Camera& camera);

/// Half the size with the sharpness of a view rendered at that size: the binomial filter of 8 taps
/// (variance 7/4) turns the point spread of the large image (variance 1/2 of its pixels) into pixel
/// average and point spread of the small one (variance 1/4 + 4 * 1/2). Borders repeat.
ImageF halvedAsRendered(const ImageF& image);

}  // namespace photonav
