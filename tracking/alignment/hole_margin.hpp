// SPDX-License-Identifier: BSD-3-Clause
// Pixels beside holes of a model, when the pose is not known to the pixel.
#pragma once

#include "geometry/camera.hpp"
#include "geometry/uncertain_pose.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Harmonic mean; 1 where there is no surface [m].
double meanDepth(const View& view);

/// How far holes reach into a view [pixels].
struct HoleMargin {
    int columns = 0;
    int rows = 0;
};

/// Pixels within three standard deviations of a hole's border may show the hole, whose content is
/// unknown, so that their difference from the prediction is no evidence about the pose. The margin
/// is at most the basin of convergence of an alignment.
/// @param covariance of the camera's pose (camera frame, left)
/// @param depth mean of the view [m]
HoleMargin holeMargin(const Matrix6& covariance, const Camera& camera, double depth);

/// Takes the depth away from pixels within the margin of one that has none.
void widenHoles(View& view, const HoleMargin& margin);

}  // namespace photonav
