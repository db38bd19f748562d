// SPDX-License-Identifier: BSD-3-Clause
// Runs photonav's planners in OMPL's benchmark (ompl::tools::Benchmark).
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "sweep/sweep_runs.hpp"

namespace photonav {

/// The best cost of a run over time.
struct BenchmarkCurve {
    std::string planner;
    std::vector<double> seconds;
    std::vector<double> cost;  ///< by the planner's own model; infinite until the goal was reached
};

struct BenchmarkOutcome {
    std::vector<SweepRun> runs;
    std::vector<BenchmarkCurve> curves;  ///< one per run
    std::string log;                     ///< in the format of ompl_benchmark_statistics
};

struct BenchmarkLimits {
    double interval = 0.01;   ///< time between samples of the progress [s]
    double timeLimit = 600.;  ///< longest duration of a run [s]
};

/// Runs the planners in the config's section `sweep` one after the other, with planner.alpha and
/// sweep.runs seeds. Each run starts from scratch, without cached views, and ends when it has the
/// config's number of vertices.
///
/// In addition to OMPL's properties, the log holds for every run the seed, vertices and views, and
/// the path's cost, length, mean trace and trace at the goal by the photometric beliefs. It holds
/// over time the planner's best cost, vertices, iterations and views; the last sample is the
/// result.
/// @param onRun called before each run with its item
BenchmarkOutcome benchmarkPlanners(const Config& config, const World& world,
                                   const BenchmarkLimits& limits,
                                   const std::atomic<bool>& interrupted,
                                   const std::function<void(const SweepItem&)>& onRun);

}  // namespace photonav
