// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "control/body_velocity.hpp"

namespace photonav {

/// Limits of velocity and acceleration of a MAV near hover.
struct MotionLimits {
    double maxSpeed = 1.;            ///< [m/s]
    double maxYawRate = 2.;          ///< [rad/s]
    double maxAcceleration = 2.;     ///< [m/s^2]
    double maxYawAcceleration = 4.;  ///< [rad/s^2]
};

/// Brings a command within the velocity limits, keeping its direction, and to what can be reached
/// from the last command within `dt` seconds.
/// @param last the last command, turned into the present axes of the body
BodyVelocity limited(const BodyVelocity& wanted, const BodyVelocity& last,
                     const MotionLimits& limits, double dt);

}  // namespace photonav
