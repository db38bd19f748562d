// SPDX-License-Identifier: BSD-3-Clause
// What a robot measures: images and its own motion.
#pragma once

#include <optional>
#include <vector>

#include "geometry/uncertain_pose.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// An image, and when it was exposed.
struct CameraFrame {
    double time = 0.;  ///< [s]
    View view;         ///< depth 0 where it was not measured, empty without a depth sensor
};

/// What was measured between the observation before and `time`.
struct Observation {
    double time = 0.;  ///< [s]
    /// Motion of the body since the observation before, covariance in its new frame (left); none
    /// where the robot has no odometry.
    std::optional<UncertainPose> T_next_now;
    std::vector<CameraFrame>
        frames;  ///< arrived by now, oldest first; exposed at `time` or earlier
};

}  // namespace photonav
