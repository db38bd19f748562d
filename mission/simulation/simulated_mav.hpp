// SPDX-License-Identifier: BSD-3-Clause
// A simulated small multirotor near hover, with odometry and a gyroscope.
#pragma once

#include <cstdint>
#include <random>

#include "control/body_velocity.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

struct MavOptions {
    double lag = 0.25;  ///< time constant of the velocity's response [s]
    /// Assumed covariance of the measured motion per metre flown, body frame, left perturbation.
    Matrix6 odometryNoise = Matrix6::Zero();
    double rotationWeight = 0.25;  ///< a turn by 1 rad has the noise of rotationWeight metres
    double odometryFactor = 1.;    ///< true odometry variance divided by the assumed one
    /// Standard deviation of the rotation that a gyroscope measures over one second [rad]; its
    /// square grows with time. 0: no gyroscope.
    double gyroscopeNoise = 0.;
    /// Standard deviation, per axis, of a random velocity that the controller does not remove, such
    /// as wind or trim [m/s].
    double drift = 0.;
    double driftTime = 2.;  ///< correlation time of the drift [s]
};

/// The true pose of the body, moved by velocity commands and by drift, and its odometry. The body
/// has inertia: its velocity in the world follows the commands with a first-order lag. Odometry:
/// the motion of every step is measured with noise whose covariance is odometryFactor times the
/// assumed one. The rotation that a gyroscope measures is fused with it. Deterministic for a seed.
class SimulatedMav {
  public:
    /// @param T_w_b initial pose
    /// @throws std::invalid_argument for a negative lag, factor, noise or drift, and for a drift
    ///         time that is not positive
    SimulatedMav(const Pose& T_w_b, const MavOptions& options, std::uint64_t seed);

    /// Flies for `dt` seconds.
    /// @return the measured motion T_next_now of the body, with its assumed covariance
    UncertainPose step(const BodyVelocity& command, double dt);

    const Pose& T_w_b() const { return T_w_b_; }
    /// Present velocity due to the commands, without drift, in body axes.
    BodyVelocity velocity() const { return {T_w_b_.linear().transpose() * velocity_w_, yawRate_}; }

  private:
    void changeDrift(double dt);
    void fuseGyroscope(double dt, Vector6& error, Matrix6& covariance);

    Pose T_w_b_;
    MavOptions options_;
    Matrix6 noiseRoot_;  // noiseRoot noiseRoot^T is the odometry's covariance per metre
    Eigen::Vector3d velocity_w_ = Eigen::Vector3d::Zero();  // [m/s]
    double yawRate_ = 0.;                                   // [rad/s]
    Eigen::Vector3d drift_w_ = Eigen::Vector3d::Zero();     // [m/s]
    std::mt19937_64 random_, driftRandom_, gyroscopeRandom_;
};

}  // namespace photonav
