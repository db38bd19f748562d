// SPDX-License-Identifier: BSD-3-Clause
// `photonav reference`: the best paths that can be found, for others to be measured against.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace photonav {

struct ReferenceOptions {
    std::string config;                  ///< YAML file
    std::vector<std::string> overrides;  ///< key.path=value
    unsigned runs = 10;                  ///< seeds per planner and alpha
    unsigned vertices = 20000;
    unsigned labels = 20;
    unsigned moves = 200000;   ///< tried by the descent from each path
    std::string file;          ///< the table; default: reference/<name>.csv beside the config
    bool fromScratch = false;  ///< forgets the paths known so far
    bool quiet = false;
};

/// Plans with every planner, alpha and seed, descends from each path, and keeps the best per alpha
/// in a table that is written after every run. Known paths are judged anew and descended from
/// first, so a cost in the table never rises while the problem stays the same.
/// @return the exit code; 1 when there is an alpha without a path
/// @throws InputError for bad input
int runReference(const ReferenceOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
