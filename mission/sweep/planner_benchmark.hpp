// SPDX-License-Identifier: BSD-3-Clause
// Our planners in OMPL's benchmark.
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
    std::vector<double> cost;  ///< the planner's own, infinite until the goal was reached
};

struct BenchmarkOutcome {
    std::vector<SweepRun> runs;
    std::vector<BenchmarkCurve> curves;  ///< one per run
    std::string log;                     ///< as ompl_benchmark_statistics reads it
};

struct BenchmarkLimits {
    double interval = 0.01;   ///< between samples of the progress [s]
    double timeLimit = 600.;  ///< of a run [s]
};

/// Runs the planners of the config's sweep with its alpha and seeds one after the other, each run
/// from scratch, until it has the config's number of vertices.
///
/// Beside OMPL's own, the log holds per run the seed, cost, length, mean trace and trace at the
/// goal of the path by the photometric beliefs, vertices and views; and over time the
/// planner's best cost, vertices, iterations and views, the last sample being the result.
/// @param onRun called before each run with what is about to be done
BenchmarkOutcome benchmarkPlanners(const Config& config, const World& world,
                                   const BenchmarkLimits& limits,
                                   const std::atomic<bool>& interrupted,
                                   const std::function<void(const SweepItem&)>& onRun);

}  // namespace photonav
