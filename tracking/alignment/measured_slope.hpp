// SPDX-License-Identifier: BSD-3-Clause
// Finite-difference check of the Jacobian against the images of a model.
#pragma once

#include <functional>

#include "alignment/alignment.hpp"

namespace photonav {

/// Comparison of the image predicted here, taken as observed, with the one predicted at exp(xi^)
/// from here, weighted so that squares are -2 log likelihoods (AtA, Atr).
using Walk = std::function<NormalEquations(const Pose& T_away_here)>;

/// J is a slope by central differences over two pixels. Predicted images are not that smooth: edges
/// of surfaces and of sharp textures jump from pixel to pixel, and across an edge that is askew J
/// is not zero along it, where nothing changes. So the camera walks, in the model, one standard
/// deviation to either side along each of six directions, which gives the slope D of the image over
/// as far as it is uncertain. An estimate that compares images by J has the information
///     D^T J (J^T J)^-1 J^T D / sigma^2 = (J M)^T (J M) / sigma^2,   M = (J^T J)^-1 J^T D
/// ("sandwich": Godambe 1960, Huber 1967), in no direction more than J gives: where D is steeper,
/// an edge happens to cross the middle of a pixel.
/// @param prior covariance of the pose, left, camera frame; none: one mean depth and one radian.
///        There is no walk along directions of which the image informs much less
/// @param floors least standard deviations of the result: none along directions that they decide
/// @return M
Matrix6 measuredSlope(const std::optional<Matrix6>& prior, const TrustOptions& floors,
                      const Walk& walk);

}  // namespace photonav
