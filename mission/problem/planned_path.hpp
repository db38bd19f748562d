// SPDX-License-Identifier: BSD-3-Clause
// A plan from the result folder of `photonav plan`.
#pragma once

#include <filesystem>
#include <optional>

#include "problem/planning_problem.hpp"

namespace photonav {

/// A config, and the plan made from it if there is one already.
struct PlanSource {
    std::string configFile;
    std::filesystem::path resultFile;  ///< result.json of `photonav plan`; empty: none
};

/// @param argument a config, a result folder of `photonav plan`, or its result.json or path.tum
/// @throws InputError for a folder that has no plan
PlanSource findPlan(const std::string& argument);

/// The path of a result.json, judged anew.
/// @throws InputError naming file and key for a result of another command or without a path
EvaluatedPath readPlannedPath(const std::filesystem::path& resultFile, PlanningProblem& problem,
                              const std::atomic<bool>& interrupted = kNotInterrupted);

}  // namespace photonav
