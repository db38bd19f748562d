// SPDX-License-Identifier: BSD-3-Clause
// A small multirotor near hover, and its odometry.
#pragma once

#include <cstdint>
#include <random>

#include "control/body_velocity.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

struct MavOptions {
    double lag = 0.25;  ///< time constant of the velocity's response [s]
    /// Covariance of the measured motion per metre flown, body frame, left perturbation;
    /// what the planner assumes.
    Matrix6 odometryNoise = Matrix6::Zero();
    double rotationWeight = 0.25;  ///< metres flown that turning by a radian counts as
    double odometryFactor = 1.;    ///< true odometry variance divided by the assumed one
    /// Standard deviation, in each direction, of a velocity that the controller does not remove
    /// (wind, trim) [m/s], and the time over which it changes [s].
    double drift = 0.;
    double driftTime = 2.;
};

/// The true pose of the body, moved by velocity commands with a first-order lag and by drift, and
/// its odometry: every step is measured with noise drawn from (odometryFactor times) the assumed
/// covariance.
/// Deterministic for a seed.
class SimulatedMav {
  public:
    /// @throws std::invalid_argument for a negative lag, factor or drift, or no time of drift
    SimulatedMav(const Pose& T_w_b, const MavOptions& options, std::uint64_t seed);

    /// Flies for `dt` seconds.
    /// @return the measured motion T_next_now of the body, with the covariance assumed of it
    UncertainPose step(const BodyVelocity& command, double dt);

    const Pose& T_w_b() const { return T_w_b_; }
    /// Response to the commands, without drift.
    const BodyVelocity& velocity() const { return velocity_; }

  private:
    void changeDrift(double dt);

    Pose T_w_b_;
    MavOptions options_;
    Matrix6 noiseRoot_;  // noiseRoot noiseRoot^T is the odometry's covariance per metre
    BodyVelocity velocity_;
    Eigen::Vector3d drift_w_ = Eigen::Vector3d::Zero();  // [m/s]
    std::mt19937_64 random_, driftRandom_;
};

}  // namespace photonav
