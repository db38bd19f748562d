// SPDX-License-Identifier: BSD-3-Clause
// `photonav check`: whether a trajectory of any origin keeps the camera localised.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "check/localisation_check.hpp"
#include "shared/command_io.hpp"

namespace photonav {

/// The config may be left out where there is a map or a scene: bounds, start and goal are then
/// those of the trajectory, all else has its default.
struct CheckCommandOptions : CommandOptions {
    std::string trajectory;           ///< TUM file, table or waypoints
    std::string map, scene;           ///< in place of the config's; at most one
    std::string heading = "forward";  ///< of a table without headings: forward, or a number [rad]
    CheckOptions check;
    unsigned flights = 0;  ///< flown along it in simulation
    unsigned jobs = 1;     ///< threads of the flights
};

/// Carries the belief along the trajectory and writes result.json, config.yaml, path.tum,
/// top_view.png, sigma.png, trace.png, report.json and report.html; with headings also
/// headings.png.
/// @return the exit code: 1 if the camera would be lost
/// @throws InputError for bad input, before anything is written
int runCheck(const CheckCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
