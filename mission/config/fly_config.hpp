// SPDX-License-Identifier: BSD-3-Clause
// The section `fly` of a config: how often and under which conditions a plan is flown.
#pragma once

#include <optional>
#include <string>

#include "geometry/types.hpp"

namespace photonav {

struct FlyConfig {
    std::string plan;       ///< result.json of `photonav plan` to fly, absolute; empty: plan anew
    unsigned flights = 20;  ///< per planner
    double speed = 1.;      ///< at most [m/s]
    double rate = 0.;       ///< of the camera [Hz]; 0: a view every planner.ds at full speed
    double latency = 0.05;  ///< of images [s]
    double drop = 0.;       ///< share of the images that never arrive
    double black = 0.;      ///< share of the images that are black
    Eigen::Vector2d blackout = Eigen::Vector2d::Zero();  ///< all are black: from, how long [s]
    std::string camera = "assumed";  ///< noise of images: as planned with, or as of a real camera
    double odometry = 1.;            ///< true odometry variance / the assumed one
    double bodyRadius = 0.;          ///< of collisions [m]; 0: half of robot.radius
    bool photometricGoal = true;     ///< servo on the goal's image at the end
    std::string map;  ///< octree, mesh or scene file to track in, absolute; empty: the true world
    std::optional<double> scale;               ///< factor on the measured information; none: 1
    std::optional<double> leastSigma;          ///< least standard deviations of an alignment [m]
    std::optional<double> leastSigmaRotation;  ///< [rad]; none: 0
};

}  // namespace photonav
