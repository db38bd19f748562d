// SPDX-License-Identifier: BSD-3-Clause
// `photonav benchmark`: planners in OMPL's benchmark, for its tools to read.
#pragma once

#include <atomic>
#include <optional>

#include "shared/command_io.hpp"

namespace photonav {

struct BenchmarkOptions : CommandOptions {
    double interval = 0.01;   ///< between samples of the progress [s]
    double timeLimit = 600.;  ///< of a run [s]; runs end with their vertices before
};

/// Runs every planner with the config's alpha and writes benchmark.log (OMPL's format, for
/// ompl_benchmark_statistics and Planner Arena), progress.png, config.yaml, report.json,
/// report.html and result.json.
/// @param interrupted when set, the benchmark ends after the run in progress (130)
/// @return the exit code; 1 when no run found a path
/// @throws InputError for bad input, before anything is written
int runBenchmark(const BenchmarkOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
