// SPDX-License-Identifier: BSD-3-Clause
// Where a camera probably is at the next image, from how it moved before.
#pragma once

#include <algorithm>

#include "geometry/se3.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

struct MotionNoise {
    double speed = 0.5;  ///< standard deviation of a velocity's change between images [m/s]
    double turn = 1.;    ///< of an angular velocity's [rad/s]
};

/// Constant velocity in the camera frame; none after a loss.
class MotionModel {
  public:
    explicit MotionModel(const MotionNoise& noise) : noise_(noise) {}

    /// The motion T_next_now within `seconds`, covariance in the next camera frame.
    UncertainPose predict(double seconds) const {
        const double dt = std::max(0., seconds);
        UncertainPose motion{expSE3(dt * velocity_), Matrix6::Zero()};
        motion.covariance.diagonal() << Eigen::Vector3d::Constant(square(noise_.speed * dt)),
            Eigen::Vector3d::Constant(square(noise_.turn * dt));
        return motion;
    }

    void observe(const Pose& T_next_now, double seconds) {
        if (seconds > 0.) velocity_ = logSE3(T_next_now) / seconds;
    }

    void forget() { velocity_.setZero(); }

  private:
    static double square(double x) { return x * x; }

    MotionNoise noise_;
    Vector6 velocity_ = Vector6::Zero();
};

}  // namespace photonav
