// SPDX-License-Identifier: BSD-3-Clause
// Carries out the runs of a sweep.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "problem/planning_problem.hpp"
#include "sweep/sweep_journal.hpp"

namespace photonav {

/// Plans one item from scratch, without cached views, so that its numbers do not depend on earlier
/// runs. The path is evaluated by the photometric beliefs with the item's alpha, whatever its
/// planner.
/// @return nothing when interrupted
/// @throws Interrupted when it is interrupted inside a large view
std::optional<SweepRun> runItem(const Config& config, const World& world, const SweepItem& item,
                                const std::atomic<bool>& interrupted);

/// Runs items on `jobs` threads. Apart from wall-clock times, the results do not depend on `jobs`.
/// @param onRun called after each run, never by two threads at a time
/// @throws the first exception that a run or onRun throws
void runItems(const Config& config, const World& world, const std::vector<SweepItem>& items,
              unsigned jobs, const std::atomic<bool>& interrupted,
              const std::function<void(const SweepRun&)>& onRun);

/// Copies cost, length, traces and waypoints of a path into a run.
void setPath(SweepRun& run, const EvaluatedPath& path);

}  // namespace photonav
