// SPDX-License-Identifier: BSD-3-Clause
// Flying to planned views: ViSP's visual servoing on the estimated pose.
#pragma once

#include <memory>

#include "control/body_velocity.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// Pose-based visual servoing (vpServo; features: translation and theta-u of the current in the
/// wanted camera frame) with the four velocities of a MAV near hover. Roll and pitch are not
/// controlled, so their errors remain.
class WaypointServo {
  public:
    /// @param T_b_c camera mount
    /// @param gain of the error's exponential decrease [1/s]
    WaypointServo(const Pose& T_b_c, double gain);
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
