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

/// Constant velocity in the camera frame, and its covariance; both 0 before the first observe() and
/// after forget(). A direction in which images do not inform has the velocity that was extrapolated
/// to it: there the covariance grows from image to image, and that of the position faster.
class MotionModel {
  public:
    explicit MotionModel(const MotionNoise& noise) : noise_(noise) {}

    /// The predicted motion T_next_now after `seconds`, covariance in the next camera frame.
    UncertainPose predict(double seconds) const {
        const double dt = std::max(0., seconds);
        Vector6 change;
        change << Eigen::Vector3d::Constant(noise_.speed), Eigen::Vector3d::Constant(noise_.turn);
        Matrix6 covariance = covariance_;
        covariance.diagonal() += change.cwiseAbs2();
        return {expSE3(dt * velocity_), dt * dt * covariance};
    }

    /// Sets the velocity by a motion T_next_now of the camera that took `seconds`.
    void observe(const UncertainPose& motion, double seconds) {
        if (!(seconds > 0.)) return;
        velocity_ = logSE3(motion.mean) / seconds;
        covariance_ = motion.covariance / (seconds * seconds);
    }

    /// Sets the velocity to 0.
    void forget() { *this = MotionModel(noise_); }

  private:
    MotionNoise noise_;
    Vector6 velocity_ = Vector6::Zero();
    Matrix6 covariance_ = Matrix6::Zero();  ///< of velocity_
};

/// A motion after the pose that it led to was observed: that of a smoother. A correction of the
/// pose corrects the motion as far as the motion, not the pose before it, was uncertain.
/// @param motion    before, as MotionModel::predict()
/// @param predicted, observed the pose after the motion; all covariances in the same frame
inline UncertainPose motionAfter(const UncertainPose& motion, const UncertainPose& predicted,
                                 const UncertainPose& observed) {
    const Matrix6 gain = predicted.covariance.ldlt().solve(motion.covariance).transpose();
    const Vector6 correction = logSE3(observed.mean * predicted.mean.inverse());
    return {
        expSE3(gain * correction) * motion.mean,
        motion.covariance - gain * (predicted.covariance - observed.covariance) * gain.transpose()};
}

}  // namespace photonav
