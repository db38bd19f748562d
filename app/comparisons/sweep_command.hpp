// SPDX-License-Identifier: BSD-3-Clause
// `photonav sweep`: compares planners over values of alpha and seeds, in one table.
#pragma once

#include <atomic>

#include "shared/many_runs.hpp"

namespace photonav {

/// Runs all combinations of planner, alpha and seed, or merges the shards of a sweep. Writes
/// runs.jsonl, runs.csv, summary.csv, sweep.png, pareto.png, paths.png, config.yaml, report.json,
/// report.html and result.json.
/// @param interrupted when set, runs in progress are dropped, and the finished runs are reported
///        (exit code 130)
/// @return the exit code: kNoAnswer if no run found a path
/// @throws InputError for bad input, before anything is written
int runSweep(const ManyRunsOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
