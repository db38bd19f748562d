// SPDX-License-Identifier: BSD-3-Clause
// The exposure of an image relative to a view at the same pose.
#pragma once

#include "alignment/normal_equations.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Gain and offset of an image relative to a view of a model, observed = gain * predicted + offset.
/// The means of blocks of 8 x 8 pixels are compared: sharpness, noise and small errors of the pose
/// hardly change them. Single pixels would give too small a gain, because what image and view do
/// not share looks like a lack of contrast. Blocks with pixels that the view does not show, or that
/// the sensor clips, are left out. Blocks that contradict the others have less weight (Cauchy).
/// @param last exposure of the image before, near which the exposure is expected: standard
///        deviations of 0.1 of the gain, and of 0.003 of the offset (as in realCameraOptions())
/// @return `last` if the difference is within three standard deviations of chance, or if the gain
///         more than doubles or halves: then the image does not show what the view predicts
/// @throws std::invalid_argument when the images differ in size
Exposure fittedExposure(const ImageF& observed, const View& predicted, const Exposure& last);

}  // namespace photonav
