// SPDX-License-Identifier: BSD-3-Clause
// `photonav compare`: every planner, information model and objective on the same problems.
#pragma once

#include <atomic>
#include <vector>

#include "commands/command_io.hpp"
#include "plot/color.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {

struct CompareOptions {
    std::vector<std::string> configs;    ///< YAML files
    std::vector<std::string> overrides;  ///< key.path=value, for all of them
    std::filesystem::path out = "out/compare";
    unsigned runs = 3;  ///< seeds: the config's and those after it
    bool quiet = false;
};

/// A planner and its information model.
struct CompareMethod {
    std::string planner;      ///< planner.name
    std::string information;  ///< planner.information
    Color color;              ///< in pictures
    /// RRBT keeps all beliefs: 19 thousand on 300 vertices of the stripes, 138 on 1000.
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

/// Writes, for every config, <name>.md (table) and <name>.png (the first seed's paths from above)
/// and at last result.json with all runs. An interrupt leaves out the run in progress and all later
/// ones.
/// @return the exit code; 1 when no run found a path
/// @throws InputError also when two configs have the same name
int runCompare(const CompareOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
