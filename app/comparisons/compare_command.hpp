// SPDX-License-Identifier: BSD-3-Clause
// `photonav compare`: every planner, information model and objective on the same problems.
#pragma once

#include <atomic>
#include <vector>

#include "shared/command_io.hpp"
#include "sweep/comparison.hpp"

namespace photonav {

struct CompareOptions {
    std::vector<std::string> configs;    ///< YAML files
    std::vector<std::string> overrides;  ///< key.path=value, for all of them
    std::filesystem::path out = "out/compare";
    unsigned runs = 3;  ///< seeds: the config's and those after it
    bool quiet = false;
};

/// Writes, for every config, <name>.md (table) and <name>.png (the first seed's paths from above)
/// and at last result.json with all runs. An interrupt leaves out the run in progress and all later
/// ones.
/// @return the exit code; 1 when no run found a path
/// @throws InputError also when two configs have the same name
int runCompare(const CompareOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
