// SPDX-License-Identifier: BSD-3-Clause
// Reads a plan from the result folder of `photonav plan`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/config.hpp"

namespace photonav {

/// A config, and a plan made from it if there is one.
struct PlanSource {
    std::string configFile;
    std::filesystem::path resultFile;  ///< result.json of `photonav plan`; empty: none
};

/// @param argument a config, a result folder of `photonav plan`, or its result.json or path.tum
/// @throws InputError for a folder that has no plan
PlanSource findPlan(const std::string& argument);

struct PlannedPath {
    std::string planner;
    std::vector<Place> waypoints;  ///< at least two, with headings
};

/// Reads the waypoints of a result.json.
/// @param config the plan's
/// @throws InputError naming file and key for a result of another command, one without a path, a
///         waypoint out of the config's bounds, a path of more than 1e5 steps of planner.ds, or one
///         that does not lead from the config's start to its goal
PlannedPath readPlannedPath(const std::filesystem::path& resultFile, const Config& config);

}  // namespace photonav
