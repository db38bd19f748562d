// SPDX-License-Identifier: BSD-3-Clause
// Planners and information models on the same problems.
#pragma once

#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "problem/planning_problem.hpp"

namespace photonav {

/// A planner and its information model.
struct CompareMethod {
    std::string planner;       ///< planner.name
    std::string information;   ///< planner.information
    unsigned maxVertices = 0;  ///< 0: those of the config

    std::string label() const;
};

/// All that can be chosen by name, one by one.
const std::vector<CompareMethod>& compareMethods();

/// One run of a method.
struct CompareRun {
    std::string method;
    std::uint32_t seed = 0;
    PlanOutcome outcome;
    std::string status;  ///< "done", or why there is no path
};

/// Runs a method on a problem. The path is judged by the photometric beliefs and the config's
/// alpha.
CompareRun runMethod(const Config& config, const World& world, const CompareMethod& method,
                     std::uint32_t seed, const std::atomic<bool>& interrupted);

/// Rows of a Markdown table: mean +- standard deviation over the seeds, methods in their order,
/// with the number of runs that found a path where some did not.
std::string compareTable(const std::vector<CompareRun>& runs);

nlohmann::json toJson(const CompareRun& run);

}  // namespace photonav
