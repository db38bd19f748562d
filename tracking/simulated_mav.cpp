// SPDX-License-Identifier: BSD-3-Clause
#include "simulated_mav.hpp"

#include <cmath>
#include <stdexcept>

#include "se3.hpp"

namespace photonav {

Matrix6 rootOf(const Matrix6& covariance) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(covariance);
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal();
}

Vector6 draw(const Matrix6& root, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Vector6 z;
    for (double& component : z) component = normal(random);
    return root * z;
}

SimulatedMav::SimulatedMav(const Pose& T_w_b, const MavOptions& options, std::uint64_t seed)
    : T_w_b_(T_w_b),
      options_(options),
      noiseRoot_(rootOf(options.odometryFactor * options.odometryNoise)),
      random_(seed) {
    if (!(options.lag >= 0.) || !(options.odometryFactor >= 0.)) {
        throw std::invalid_argument("simulated MAV: negative lag or odometry factor");
    }
}

UncertainPose SimulatedMav::step(const BodyVelocity& command, double dt) {
    // The exact response of a first-order lag to a constant command; its mean moves the body.
    const double lag = options_.lag;
    const double left = lag > 0. ? std::exp(-dt / lag) : 0.;
    const double mean = lag > 0. ? lag / dt * (1. - left) : 0.;
    const auto respond = [&](auto now, auto wanted) { return wanted + (now - wanted) * left; };
    Vector6 motion = Vector6::Zero();  // of the body, in its own axes
    motion.head<3>() = dt * (command.linear + mean * (velocity_.linear - command.linear));
    motion[5] = dt * (command.yawRate + mean * (velocity_.yawRate - command.yawRate));
    velocity_.linear = respond(velocity_.linear, Eigen::Vector3d(command.linear)).eval();
    velocity_.yawRate = respond(velocity_.yawRate, command.yawRate);

    const Pose T_next_now = expSE3(-motion);
    T_w_b_ = T_w_b_ * T_next_now.inverse();
    const double way = motion.head<3>().norm() + options_.rotationWeight * std::abs(motion[5]);
    // The true motion is exp(xi^) times the measured one.
    const Vector6 xi = std::sqrt(way) * draw(noiseRoot_, random_);
    return {expSE3(-xi) * T_next_now, way * options_.odometryNoise};
}

}  // namespace photonav
