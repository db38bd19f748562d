// SPDX-License-Identifier: BSD-3-Clause
// Images of a run as PNG.
#pragma once

#include <string>

#include "types.hpp"

namespace photonav {

/// The bytes of a PNG file; writeFileAtomically() takes them as they are.
using Png = std::string;

/// A grey image in [0, 1], reduced to at most `maxSide` pixels a side.
/// @throws std::invalid_argument if the image is empty
Png greyPng(const ImageF& image, unsigned maxSide = 2048);

/// The contribution of each pixel (see contributionImage()) as colour over the dimmed grey image.
/// The square root is shown, scaled to its 99.5th percentile: weak pixels stay visible.
/// @throws std::invalid_argument if the sizes differ or the images are empty
Png contributionPng(const ImageF& intensity, const ImageF& contribution);

}  // namespace photonav
