// SPDX-License-Identifier: BSD-3-Clause
// Finite-difference check of the Jacobian against the images of a model.
#pragma once

#include <functional>

#include "alignment/alignment.hpp"

namespace photonav {

/// Compares the image predicted at this pose, taken as observed, with the one predicted at exp(xi^)
/// times this pose, weighted so that squares are -2 log likelihoods (AtA, Atr).
using DisplacedComparison = std::function<NormalEquations(const Pose& T_away_here)>;

/// J is a slope by central differences over two pixels. Predicted images are not that smooth: edges
/// of surfaces and of sharp textures jump from pixel to pixel, and along an oblique edge J is not
/// zero, although the image does not change. Therefore the camera is displaced in the model by one
/// standard deviation to either side along each of six directions, which gives the slope D of the
/// image over the uncertainty of the pose. An estimate that compares images by J has the
/// information
///     D^T J (J^T J)^-1 J^T D / sigma^2 = (J M)^T (J M) / sigma^2,   M = (J^T J)^-1 J^T D
/// ("sandwich": Godambe 1960, Huber 1967), limited in every direction to what J gives: D is steeper
/// only if an edge happens to cross the middle of a pixel.
/// @param prior covariance of the pose, left, camera frame; none: one mean depth and one radian.
///        Directions about which the image informs much less are not measured.
/// @param trust least standard deviations of the result. Directions that they determine are not
///        measured.
/// @return M
Matrix6 measuredSlope(const std::optional<Matrix6>& prior, const TrustOptions& trust,
                      const DisplacedComparison& compare);

}  // namespace photonav
