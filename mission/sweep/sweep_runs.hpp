// SPDX-License-Identifier: BSD-3-Clause
// Doing the runs of a sweep.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "problem/planning_problem.hpp"
#include "sweep/sweep_journal.hpp"

namespace photonav {

/// Plans one item from scratch, with no cached views, so that its numbers depend on no earlier run.
/// Every planner's path is evaluated by the photometric beliefs with the item's alpha.
/// @return nothing when interrupted
std::optional<SweepRun> runItem(const Config& config, const World& world, const SweepItem& item,
                                const std::atomic<bool>& interrupted);

/// Runs items on `jobs` threads. The results of runs (but their seconds) do not depend on `jobs`.
/// @param onRun called after each run, never twice at a time
/// @throws what a run or onRun threw first
void runItems(const Config& config, const World& world, const std::vector<SweepItem>& items,
              unsigned jobs, const std::atomic<bool>& interrupted,
              const std::function<void(const SweepRun&)>& onRun);

/// Stores what a run has found.
void setPath(SweepRun& run, const EvaluatedPath& path);

}  // namespace photonav
