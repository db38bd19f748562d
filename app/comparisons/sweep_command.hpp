// SPDX-License-Identifier: BSD-3-Clause
// `photonav sweep`: many planners, trade-offs and seeds, as one table.
#pragma once

#include <atomic>

#include "shared/many_runs.hpp"

namespace photonav {

/// Runs all combinations and writes runs.jsonl, runs.csv, summary.csv, sweep.png, pareto.png,
/// paths.png, config.yaml, report.json, report.html and result.json.
/// @param interrupted when set, the runs in progress are dropped and the rest is reported (130)
/// @return the exit code; 1 when no run found a path
/// @throws InputError for bad input, before anything is written
int runSweep(const ManyRunsOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
