// SPDX-License-Identifier: BSD-3-Clause
// `photonav compare`: compares all planners, information models and objectives on the same
// problems.
#pragma once

#include <atomic>
#include <vector>

#include "shared/command_io.hpp"
#include "sweep/comparison.hpp"

namespace photonav {

struct CompareOptions {
    std::vector<std::string> configs;    ///< YAML files of planning problems
    std::vector<std::string> overrides;  ///< key.path=value, for all configs
    std::filesystem::path out = "out/compare";
    unsigned runs = 3;        ///< number of seeds per method, from the config's seed on
    bool quiet = false;       ///< print no progress and no tables
    bool json = false;        ///< print result.json on standard output, without tables
    std::string commandLine;  ///< the command as typed, for the report
};

/// Writes for every config <name>.md (a table) and <name>.png (the first path of each method, from
/// above), report.json and report.html with all tables and the paths of the first config in 3-D,
/// and finally result.json with all runs. With one config, config.yaml is written, too.
/// @param interrupted when set, the run in progress and all later runs are left out (exit code 130)
/// @return the exit code: kNoAnswer if no run found a path
/// @throws InputError for bad input, also if two configs have the same name
int runCompare(const CompareOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
