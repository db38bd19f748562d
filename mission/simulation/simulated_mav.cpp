// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_mav.hpp"

#include <cmath>
#include <stdexcept>

#include "geometry/gaussian.hpp"
#include "geometry/rotation_information.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

// For random numbers of their own.
constexpr std::uint64_t kDriftSeed = 0x9e3779b97f4a7c15, kGyroscopeSeed = 0xbf58476d1ce4e5b9;

}  // namespace

SimulatedMav::SimulatedMav(const Pose& T_w_b, const MavOptions& options, std::uint64_t seed)
    : T_w_b_(T_w_b),
      options_(options),
      noiseRoot_(rootOf(options.odometryFactor * options.odometryNoise)),
      random_(seed),
      driftRandom_(seed ^ kDriftSeed),
      gyroscopeRandom_(seed ^ kGyroscopeSeed) {
    if (!(options.lag >= 0.) || !(options.odometryFactor >= 0.)) {
        throw std::invalid_argument("simulated MAV: negative lag or odometry factor");
    }
    if (!(options.gyroscopeNoise >= 0.)) {
        throw std::invalid_argument("simulated MAV: negative noise of the gyroscope");
    }
    if (!(options.drift >= 0.) || !(options.driftTime > 0.)) {
        throw std::invalid_argument("simulated MAV: negative drift, or no time of drift");
    }
}

/// A first-order Gauss-Markov process.
void SimulatedMav::changeDrift(double dt) {
    const double kept = std::exp(-dt / options_.driftTime);
    std::normal_distribution<double> normal(0., options_.drift);
    for (double& component : drift_w_) {
        component = kept * component + std::sqrt(1. - kept * kept) * normal(driftRandom_);
    }
}

/// The weighted mean of odometry and gyroscope.
void SimulatedMav::fuseGyroscope(double dt, Vector6& error, Matrix6& covariance) {
    const double noise = options_.gyroscopeNoise;
    const Matrix6 information = rotationInformation(noise * noise * dt);
    std::normal_distribution<double> normal(0., noise * std::sqrt(dt));
    Vector6 rotation = Vector6::Zero();
    for (double& component : rotation.tail<3>()) component = normal(gyroscopeRandom_);
    const Matrix6 left = Matrix6::Identity() + covariance * information;
    error = left.partialPivLu().solve(error + covariance * information * rotation).eval();
    covariance = updateCovariance(covariance, information);
}

UncertainPose SimulatedMav::step(const BodyVelocity& command, double dt) {
    // The exact response of a first-order lag to a constant command; its mean moves the body.
    const double lag = options_.lag;
    const double left = lag > 0. ? std::exp(-dt / lag) : 0.;
    const double mean = lag > 0. ? lag / dt * (1. - left) : 0.;
    const auto respond = [&](const auto& now, const auto& wanted) {
        return wanted + (now - wanted) * left;
    };
    // A body that turns keeps its velocity in the world.
    const Eigen::Vector3d wanted_w = T_w_b_.linear() * command.linear;
    Eigen::Vector3d motion_w = dt * (wanted_w + mean * (velocity_w_ - wanted_w));
    if (options_.drift > 0.) {
        changeDrift(dt);
        motion_w += dt * drift_w_;
    }
    const double turn = dt * (command.yawRate + mean * (yawRate_ - command.yawRate));
    velocity_w_ = respond(velocity_w_, wanted_w).eval();
    yawRate_ = respond(yawRate_, command.yawRate);

    Pose T_now_next(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
    T_now_next.translation() = T_w_b_.linear().transpose() * motion_w;
    const Pose T_next_now = T_now_next.inverse();
    T_w_b_ = T_w_b_ * T_now_next;
    const double way = motion_w.norm() + options_.rotationWeight * std::abs(turn);
    // The true motion is exp(xi^) times the measured one.
    Vector6 xi = std::sqrt(way) * draw(noiseRoot_, random_);
    Matrix6 covariance = way * options_.odometryNoise;
    if (options_.gyroscopeNoise > 0.) fuseGyroscope(dt, xi, covariance);
    return {expSE3(-xi) * T_next_now, covariance};
}

}  // namespace photonav
