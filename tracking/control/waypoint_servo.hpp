// SPDX-License-Identifier: BSD-3-Clause
// Flying to planned views: ViSP's visual servoing on the estimated pose, within what a MAV can do.
#pragma once

#include <memory>

#include "control/body_velocity.hpp"
#include "geometry/types.hpp"

namespace photonav {

struct ServoOptions {
    double gain = 1.5;               ///< of the error's exponential decrease [1/s]
    double maxSpeed = 1.;            ///< [m/s]
    double maxYawRate = 1.;          ///< [rad/s]
    double maxAcceleration = 2.;     ///< [m/s^2]
    double maxYawAcceleration = 4.;  ///< [rad/s^2]
};

/// Brings a command within the velocity limits, keeping its direction, and to what can be reached
/// from the last command within `dt` seconds.
BodyVelocity limited(const BodyVelocity& wanted, const BodyVelocity& last,
                     const ServoOptions& options, double dt);

/// Pose-based visual servoing (vpServo; features: translation and theta-u of the current in the
/// wanted camera frame) with the four velocities that a MAV near hover has: what only tilting could
/// correct stays as it is.
class WaypointServo {
  public:
    /// @param T_b_c camera mount
    WaypointServo(const Pose& T_b_c, const ServoOptions& options);
    ~WaypointServo();
    WaypointServo(WaypointServo&&) noexcept;
    WaypointServo& operator=(WaypointServo&&) noexcept;

    /// Velocity toward the wanted view, before any limit.
    /// @param T_c_w estimated camera pose
    /// @param T_goal_w camera pose of the planned view
    BodyVelocity toward(const Pose& T_c_w, const Pose& T_goal_w);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace photonav
