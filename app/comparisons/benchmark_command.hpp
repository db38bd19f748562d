// SPDX-License-Identifier: BSD-3-Clause
// `photonav benchmark`: runs planners in OMPL's benchmark and writes a log for OMPL's tools.
#pragma once

#include <atomic>
#include <optional>

#include "shared/command_io.hpp"

namespace photonav {

struct BenchmarkOptions : CommandOptions {
    double interval = 0.01;   ///< time between samples of the progress [s]
    double timeLimit = 600.;  ///< longest duration of a run [s]; most runs end before, with the
                              ///< config's number of vertices
};

/// Runs the planners of sweep.planners with the config's alpha and sweep.runs seeds. Writes
/// benchmark.log (OMPL's format, for ompl_benchmark_statistics and Planner Arena), progress.png,
/// config.yaml, report.json, report.html and result.json.
/// @param interrupted when set, the benchmark ends with the run in progress, which counts only if
///        it has a path (exit code 130)
/// @return the exit code: kNoAnswer if no run found a path
/// @throws InputError for bad input, before anything is written
int runBenchmark(const BenchmarkOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
