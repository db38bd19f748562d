// SPDX-License-Identifier: BSD-3-Clause
// The interface of a flying robot for tracker and pilot: velocity commands in, measurements out.
#pragma once

#include "control/body_velocity.hpp"
#include "estimation/observation.hpp"
#include "render/area_sensor.hpp"

namespace photonav {

class Robot {
  public:
    Robot() = default;
    Robot(const Robot&) = delete;
    Robot& operator=(const Robot&) = delete;
    virtual ~Robot() = default;

    /// Flies at a commanded velocity.
    /// @param seconds duration of the command [s]; 0: the robot does not move, and only the images
    ///        are received
    /// @return odometry over this time, and the images that have arrived by its end
    virtual Observation fly(const BodyVelocity& command, double seconds) = 0;

    virtual const Camera& camera() const = 0;  ///< intrinsics of the images
    virtual const Pose& T_b_c() const = 0;     ///< camera mount
    /// Standard deviation of the point spread of the images [pixels]. The default, kAreaBlur, is
    /// for a camera in focus whose pixels average over their area. With a defocus of d pixels it is
    /// hypot(kAreaBlur, d); for images rendered by a ViewSource it is kRenderedBlur. Images that
    /// are sharper or blurrier than stated make the tracker overconfident.
    virtual double blur() const { return kAreaBlur; }
};

}  // namespace photonav
