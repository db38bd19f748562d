// SPDX-License-Identifier: BSD-3-Clause
// A flying robot as tracker and pilot use it: commands in, measurements out.
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

    /// Flies with a commanded velocity for some seconds; 0: only looks.
    /// @return odometry of that time, and the images that have arrived by its end
    virtual Observation fly(const BodyVelocity& command, double seconds) = 0;

    virtual const Camera& camera() const = 0;  ///< of the images
    virtual const Pose& T_b_c() const = 0;     ///< its mount
    /// Point spread of the images, standard deviation [pixels]. By default that of a camera in
    /// focus, whose pixels average over their area; with a defocus of d pixels hypot(kAreaBlur, d);
    /// of images that a ViewSource renders kRenderedBlur. Images that are sharper or blurrier than
    /// stated make the tracker overconfident.
    virtual double blur() const { return kAreaBlur; }
};

}  // namespace photonav
