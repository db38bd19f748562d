// SPDX-License-Identifier: BSD-3-Clause
// `photonav check`: checks whether the camera stays localised along a given trajectory.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "check/localisation_check.hpp"
#include "shared/command_io.hpp"

namespace photonav {

/// Options of the command. With a map or scene, the config may be empty. Bounds, start and goal are
/// then derived from the trajectory, and all other keys have their defaults.
struct CheckCommandOptions : CommandOptions {
    std::string trajectory;  ///< file for readGivenTrajectory()
    std::string map, scene;  ///< replace the map or scene of the config; at most one
    /// Heading for a table without headings: "forward" (along the motion), or a number [rad].
    std::string heading = "forward";
    CheckOptions check;
    unsigned flights = 0;  ///< number of simulated flights along the trajectory
    unsigned jobs = 1;     ///< number of threads for the flights
};

/// Propagates the belief along the trajectory (checkLocalisation()). Writes result.json,
/// config.yaml, path.tum, path.kitti, top_view.png, sigma.png, trace.png, report.json and
/// report.html; also headings.png if headings are compared.
/// @param interrupted when set, the results contain the places so far (exit code 130)
/// @return the exit code: kNoAnswer if the camera is lost somewhere
/// @throws InputError for bad input, before anything is written
int runCheck(const CheckCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
