// SPDX-License-Identifier: BSD-3-Clause
// What a robot measures: images and its own motion.
#pragma once

#include <optional>
#include <vector>

#include "geometry/uncertain_pose.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// The vertical as an accelerometer measures it.
struct MeasuredVertical {
    Eigen::Vector3d up_c = Eigen::Vector3d::UnitZ();  ///< unit vector, camera frame
    double sigma = 0.;  ///< standard deviation of its angle about each horizontal axis [rad]
};

/// An image, and when it was exposed.
struct CameraFrame {
    double time = 0.;  ///< [s]
    View view;         ///< depth 0 where it was not measured, empty without a depth sensor
    std::optional<MeasuredVertical> vertical = {};  ///< at the exposure
};

/// What was measured between the observation before and `time`.
struct Observation {
    double time = 0.;  ///< since take-off [s]
    /// Motion of the body since the observation before, covariance in its new frame (left); none
    /// where the robot has no odometry.
    std::optional<UncertainPose> T_next_now;
    std::vector<CameraFrame>
        frames;  ///< arrived by now, oldest first; exposed at `time` or earlier
};

}  // namespace photonav
