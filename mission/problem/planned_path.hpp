// SPDX-License-Identifier: BSD-3-Clause
// Reads a plan from the result folder of `photonav plan`.
#pragma once

#include <filesystem>
#include <optional>

#include "problem/planning_problem.hpp"

namespace photonav {

/// A config, and a plan made from it if there is one.
struct PlanSource {
    std::string configFile;
    std::filesystem::path resultFile;  ///< result.json of `photonav plan`; empty: none
};

/// @param argument a config, a result folder of `photonav plan`, or its result.json or path.tum
/// @throws InputError for a folder that has no plan
PlanSource findPlan(const std::string& argument);

/// Reads the waypoints of a result.json and evaluates the path in a problem.
/// @throws InputError naming file and key for a result of another command or without a path
/// @throws RenderingStopped when it is interrupted inside a large view
EvaluatedPath readPlannedPath(const std::filesystem::path& resultFile, PlanningProblem& problem,
                              const std::atomic<bool>& interrupted = kNotInterrupted);

}  // namespace photonav
