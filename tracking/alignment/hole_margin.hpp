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

/// Of pixels within three standard deviations of a hole's border nobody knows whether they show the
/// hole, whose content is unknown: what they differ by says nothing about the pose. No more than an
/// alignment can converge from, since it begins closer to the right place.
/// @param covariance of the camera's pose (camera frame, left)
/// @param depth mean of the view [m]
HoleMargin holeMargin(const Matrix6& covariance, const Camera& camera, double depth);

/// Takes the depth away from pixels within the margin of one that has none.
void widenHoles(View& view, const HoleMargin& margin);

}  // namespace photonav
