// SPDX-License-Identifier: BSD-3-Clause
// Finite-difference check of the Jacobian against the images of a model.
#pragma once

#include <functional>

#include "alignment/alignment.hpp"

namespace photonav {

/// Compares the image predicted at the present pose, taken as the observed image, with the image
/// predicted at a displaced pose. The equations (AtA, Atr) are weighted so that squares are -2 log
/// likelihoods.
/// @param T_away_here displacement of the camera from the present pose
using DisplacedComparison = std::function<NormalEquations(const Pose& T_away_here)>;

/// The slope M of predicted images over the uncertainty of the pose, relative to J. The gradients
/// in J are central differences over two pixels. Predicted images are not that smooth: edges of
/// cells jump from pixel to pixel, and along an oblique edge J is not
/// zero, although the image does not change. Therefore the camera is displaced in the model by one
/// standard deviation to either side along each of six directions, which gives the slope D of the
/// image over the uncertainty of the pose. An estimate that compares images by J has the
/// information
///     D^T J (J^T J)^-1 J^T D / sigma^2 = (J M)^T (J M) / sigma^2,   M = (J^T J)^-1 J^T D
/// ("sandwich": Godambe 1960, Huber 1967). It is limited in every direction to the information by
/// J: D is steeper than J only if an edge happens to cross the middle of a pixel.
/// @param prior covariance of the pose (left perturbation, camera frame); none: standard deviations
///        of one mean depth and one radian. Directions in which the image has much less information
///        than the prior are not measured.
/// @param trust least standard deviations of the result. Directions whose variance they determine
///        are not measured.
/// @return M; identity in directions that are not measured
Matrix6 measuredSlope(const std::optional<Matrix6>& prior, const TrustOptions& trust,
                      const DisplacedComparison& compare);

}  // namespace photonav
