// SPDX-License-Identifier: BSD-3-Clause
// Predicts the motion of a camera without odometry from its last velocity.
#pragma once

#include <algorithm>

#include "geometry/se3.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

struct MotionNoise {
    double speed = 0.5;  ///< standard deviation of the change of velocity between images [m/s]
    double turn = 1.;    ///< standard deviation of the change of angular velocity [rad/s]
};

/// Constant velocity in the camera frame; 0 before the first observe() and after forget().
class MotionModel {
  public:
    explicit MotionModel(const MotionNoise& noise) : noise_(noise) {}

    /// The predicted motion T_next_now after `seconds`, covariance in the next camera frame.
    UncertainPose predict(double seconds) const {
        const double dt = std::max(0., seconds);
        UncertainPose motion{expSE3(dt * velocity_), Matrix6::Zero()};
        motion.covariance.diagonal() << Eigen::Vector3d::Constant(square(noise_.speed * dt)),
            Eigen::Vector3d::Constant(square(noise_.turn * dt));
        return motion;
    }

    /// Sets the velocity by a motion of the camera that took `seconds`.
    void observe(const Pose& T_next_now, double seconds) {
        if (seconds > 0.) velocity_ = logSE3(T_next_now) / seconds;
    }

    /// Sets the velocity to 0.
    void forget() { velocity_.setZero(); }

  private:
    static double square(double x) { return x * x; }

    MotionNoise noise_;
    Vector6 velocity_ = Vector6::Zero();
};

}  // namespace photonav
