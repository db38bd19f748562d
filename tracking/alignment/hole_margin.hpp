// SPDX-License-Identifier: BSD-3-Clause
// Excludes pixels beside holes of a model, where an uncertain pose may move the hole.
#pragma once

#include "geometry/camera.hpp"
#include "geometry/uncertain_pose.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Harmonic mean of the depths of a view [m]; 1 if there is no surface in view.
double meanDepth(const View& view);

/// Width of the margin around holes of a view [pixels].
struct HoleMargin {
    int columns = 0;
    int rows = 0;
};

/// The margin around holes for an uncertain pose. Pixels within three standard deviations of a
/// hole's border may show the hole, whose content is unknown, so that their residuals have no
/// information about the pose. The margin is limited to the basin of convergence of an alignment.
/// @param covariance of the camera pose (left perturbation, camera frame)
/// @param depth mean of the view [m]
HoleMargin holeMargin(const Matrix6& covariance, const Camera& camera, double depth);

/// Sets the depth to 0 at all pixels within the margin of a pixel without depth.
void widenHoles(View& view, const HoleMargin& margin);

}  // namespace photonav
