// SPDX-License-Identifier: BSD-3-Clause
// The gain of an image relative to a view at the same pose.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

/// Gain of an image relative to a view of a model, observed = gain * predicted: the part of the
/// exposure that an automatic exposure changes. The means of blocks of 8 x 8 pixels are compared,
/// which sharpness, noise and small errors of the pose hardly change. (An offset would have to be
/// found by the contrast of the view, which a map of cells lowers: the contrast of the map would
/// fall from image to image.) Blocks with pixels that the view does not show, or that the sensor
/// clips, are left out. Blocks that contradict the others have less weight (Cauchy).
/// @param last gain of the image before, near which the gain is expected: standard deviation 0.1
/// @return `last` if the difference is within three standard deviations of chance, or if the gain
///         more than doubles or halves: then the image does not show what the view predicts
/// @throws std::invalid_argument when the images differ in size
double fittedGain(const ImageF& observed, const View& predicted, double last);

}  // namespace photonav
