// SPDX-License-Identifier: BSD-3-Clause
#include "control/motion_limits.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {

BodyVelocity limited(const BodyVelocity& wanted, const BodyVelocity& last,
                     const MotionLimits& limits, double dt) {
    const double excess = std::max(
        {1., wanted.linear.norm() / limits.maxSpeed, std::abs(wanted.yawRate) / limits.maxYawRate});
    BodyVelocity command{wanted.linear / excess, wanted.yawRate / excess};
    const Eigen::Vector3d change = command.linear - last.linear;
    const double most = limits.maxAcceleration * dt;
    if (change.norm() > most) command.linear = last.linear + change * (most / change.norm());
    const double turn = limits.maxYawAcceleration * dt;
    command.yawRate = last.yawRate + std::clamp(command.yawRate - last.yawRate, -turn, turn);
    return command;
}

}  // namespace photonav
