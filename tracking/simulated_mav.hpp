// SPDX-License-Identifier: BSD-3-Clause
// A small multirotor near hover, and the odometry it believes in.
#pragma once

#include <cstdint>
#include <random>

#include "uncertain_pose.hpp"

namespace photonav {

/// What a near-hover controller takes: the velocity of the body in its own axes.
struct BodyVelocity {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();  ///< [m/s]
    double yawRate = 0.;                               ///< about the body's z axis [rad/s]
};

struct MavOptions {
    double lag = 0.25;  ///< time constant of the velocity's response [s]
    /// Covariance of the measured motion per metre of way flown, body frame, left perturbation;
    /// what the planner assumes.
    Matrix6 odometryNoise = Matrix6::Zero();
    double rotationWeight = 0.25;  ///< metres that a radian of turning counts as way flown
    double odometryFactor = 1.;    ///< the variance really there by the variance assumed
};

/// The true pose of the body, moved by velocity commands with a first-order lag, and its odometry:
/// every step is measured with noise drawn from (odometryFactor times) what is assumed of it.
/// Deterministic for a seed.
class SimulatedMav {
  public:
    /// @throws std::invalid_argument for a lag or a factor that is negative
    SimulatedMav(const Pose& T_w_b, const MavOptions& options, std::uint64_t seed);

    /// Flies for `dt` seconds.
    /// @return the measured motion T_next_now of the body, with the covariance assumed of it
    UncertainPose step(const BodyVelocity& command, double dt);

    const Pose& T_w_b() const { return T_w_b_; }
    const BodyVelocity& velocity() const { return velocity_; }

  private:
    Pose T_w_b_;
    MavOptions options_;
    Matrix6 noiseRoot_;  // noiseRoot noiseRoot^T is the odometry's covariance per metre
    BodyVelocity velocity_;
    std::mt19937_64 random_;
};

/// A matrix A with A A^T = covariance, which may be singular.
Matrix6 rootOf(const Matrix6& covariance);

/// A draw from N(0, root root^T).
Vector6 draw(const Matrix6& root, std::mt19937_64& random);

}  // namespace photonav
