// SPDX-License-Identifier: BSD-3-Clause
// Comparison of planners and information models on the same planning problem.
#pragma once

#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "problem/planning_problem.hpp"
#include "result/text_table.hpp"

namespace photonav {

/// A planner and its information model.
struct CompareMethod {
    std::string planner;       ///< planner.name
    std::string information;   ///< planner.information
    unsigned maxVertices = 0;  ///< upper limit of planner.vertices; 0: no limit

    /// "planner, information model", or the planner alone if it uses no views.
    std::string label() const;
};

/// The methods to compare: every planner that uses views with the photometric model, the default
/// planner with every other information model, and every planner without views.
const std::vector<CompareMethod>& compareMethods();

/// One run of a method.
struct CompareRun {
    std::string method;  ///< CompareMethod::label()
    std::uint32_t seed = 0;
    PlanOutcome outcome;
    std::string status;  ///< "done", or the reason why there is no path
};

/// Runs a method on a problem. Whatever the method's information model, the path is evaluated by
/// the photometric beliefs with the config's alpha.
CompareRun runMethod(const Config& config, const World& world, const CompareMethod& method,
                     std::uint32_t seed, const std::atomic<bool>& interrupted);

/// One row per method, in the order of compareMethods(): mean +- standard deviation over the seeds.
/// The row says how many runs found a path if some did not.
TextTable comparisonTable(const std::vector<CompareRun>& runs);

/// The means of cost, length and traces only: it fits into 80 columns.
TextTable shortComparisonTable(const std::vector<CompareRun>& runs);

/// A run as an object of result.json. Without a path, cost, length and traces are left out.
nlohmann::json toJson(const CompareRun& run);

}  // namespace photonav
