// SPDX-License-Identifier: BSD-3-Clause
// `photonav reference`: computes near-optimal reference paths, with which sweeps are compared.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace photonav {

struct ReferenceOptions {
    std::string config;                  ///< YAML file
    std::vector<std::string> overrides;  ///< key.path=value
    unsigned runs = 10;                  ///< number of seeds per planner and alpha
    unsigned vertices = 20000;           ///< vertices of each run
    unsigned labels = 20;                ///< labels per vertex
    unsigned moves = 200000;             ///< number of changes that the descent tries on each path
    std::string file;                    ///< table; empty: reference/<config>.csv beside the config
    bool fromScratch = false;            ///< ignores the paths in an earlier table
    bool quiet = false;
};

/// Plans with every planner, alpha and seed, improves each path by descent, and keeps the best path
/// per alpha in a table, which is written after every run. Paths of an earlier table are first
/// evaluated again and improved by descent, so that no cost in the table rises while the problem
/// stays the same.
/// @param interrupted when set, the command ends with the paths so far (exit code 130)
/// @return the exit code: kNoAnswer if an alpha has no path
/// @throws InputError for bad input
int runReference(const ReferenceOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
