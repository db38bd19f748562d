// SPDX-License-Identifier: BSD-3-Clause
// `photonav fly`: a plan flown in closed loop, many times, beside the shortest path.
#pragma once

#include <atomic>
#include <string>

#include "command_io.hpp"

namespace photonav {

struct FlyOptions : CommandOptions {
    unsigned flights = 20;  ///< per planner
    unsigned jobs = 1;      ///< threads
    double speed = 1.;      ///< at most [m/s]
    double rate = 0.;       ///< of the camera [Hz]; 0: a view every planner.ds at full speed
    double latency = 0.05;  ///< of images [s]
    double drop = 0.;       ///< share of the images that never arrive
    double black = 0.;      ///< share of the images that are black
    std::string blackout;   ///< "start,length" of a time when all are black [s]
    std::string camera = "assumed";  ///< noise of images: as planned with, or as of a real camera
    double odometry = 1.;            ///< true variance of the odometry by what is assumed of it
    double bodyRadius = 0.;          ///< of collisions [m]; 0: half of robot.radius
    bool photometricGoal = true;     ///< servo on the goal's image at the end
    std::filesystem::path record;    ///< folder for the first flight as a recording; empty: none
};

/// Plans (or takes the plan of a result folder), flies it and writes result.json, config.yaml,
/// trajectory.tum, .cov and .ov and groundtruth.tum of the first flight, errors.png, nees.png,
/// top_view.png, report.json and report.html.
/// @param interrupted when set, flying ends with the flights that were flown (exit code 130)
/// @return the exit code: kNoAnswer when there was no path or no flight arrived
/// @throws InputError for bad input, before anything is written
int runFly(const FlyOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
