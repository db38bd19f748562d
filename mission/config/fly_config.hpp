// SPDX-License-Identifier: BSD-3-Clause
// The section `fly` of a config: how often and under which conditions a plan is flown.
#pragma once

#include <optional>
#include <string>

#include "geometry/types.hpp"

namespace photonav {

struct FlyConfig {
    std::string plan;       ///< result.json of `photonav plan`, absolute path; empty: a new plan
    unsigned flights = 20;  ///< flights per planner
    double speed = 1.;      ///< largest speed [m/s]
    double turnRate = 2.;   ///< largest turn rate (yaw) [rad/s]
    double rate = 0.;       ///< image rate [Hz]; 0: one image every planner.ds at full speed
    double latency = 0.05;  ///< delay from exposure to arrival of an image [s]
    double drop = 0.;       ///< share of the images that never arrive
    double black = 0.;      ///< share of the images that are black
    /// Start and length of a time in which all images are black [s].
    Eigen::Vector2d blackout = Eigen::Vector2d::Zero();
    std::string camera = "assumed";  ///< image noise: "assumed" as by the planner, or "real" as of
                                     ///< a real camera
    double lag = 0.25;               ///< time constant of the velocity's response [s]
    double drift = 0.;       ///< standard deviation, per axis, of a velocity not commanded [m/s]
    double odometry = 1.;    ///< true odometry variance divided by the assumed one
    double bodyRadius = 0.;  ///< radius of the body in collisions [m]; 0: half of
                             ///< robot.radius
    bool photometricGoal = true;  ///< at the end, servo on the image of the goal
    std::string map;  ///< octree, mesh or scene file to track in, absolute path; empty: the true
                      ///< world
    std::optional<double> scale;       ///< factor on the information of an alignment; none: 1
    std::optional<double> leastSigma;  ///< least standard deviation of an aligned position [m];
                                       ///< none: 0
    std::optional<double> leastSigmaRotation;  ///< least standard deviation of an aligned rotation
                                               ///< [rad]; none: 0
};

}  // namespace photonav
