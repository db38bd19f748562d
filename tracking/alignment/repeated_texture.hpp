// SPDX-License-Identifier: BSD-3-Clause
// Texture that repeats, and where else an alignment may have ended because of it.
#pragma once

#include <vector>

#include "geometry/camera.hpp"
#include "geometry/uncertain_pose.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Twists of the camera after which a part of a view looks as before: as books on a shelf do,
/// displaced by one of them. An alignment may have ended as far from the right pose. A part
/// repeats where its difference from itself, displaced, has a minimum behind a hill that image
/// noise does not level. The twist is the likeliest that displaces the part so far.
/// @param predicted at T_c_w
/// @param prior displacements are sought within three of its standard deviations
/// @param weight factor that turns a sum of squares over pixels into -2 log likelihood
std::vector<Vector6> repetitions(const View& predicted, const Pose& T_c_w,
                                 const UncertainPose& prior, const Camera& camera, double weight);

}  // namespace photonav
