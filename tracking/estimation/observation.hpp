// SPDX-License-Identifier: BSD-3-Clause
// The measurements of a robot: images and its own motion.
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

/// An image and the time of its exposure.
struct CameraFrame {
    double time = 0.;  ///< time of the exposure [s]
    View view;         ///< depth 0: not measured; the depth image is empty without a depth sensor
    std::optional<MeasuredVertical> vertical = {};  ///< at the exposure
};

/// The measurements since the last observation.
struct Observation {
    double time = 0.;  ///< since take-off [s]
    /// Motion of the body since the last observation, covariance of the left perturbation in the
    /// new body frame; none if the robot has no odometry.
    std::optional<UncertainPose> T_next_now;
    /// Images that have arrived since the last observation, oldest first; exposed at `time` or
    /// earlier.
    std::vector<CameraFrame> frames;
};

}  // namespace photonav
