// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_runs.hpp"

#include <mutex>

#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "io/interrupted.hpp"

namespace photonav {
namespace {

std::optional<SweepRun> runUnlessStopped(const Config& config, const World& world,
                                         const SweepItem& item,
                                         const std::atomic<bool>& interrupted) {
    try {
        return runItem(config, world, item, interrupted);
    } catch (const Interrupted&) {
        return std::nullopt;
    }
}

}  // namespace

std::optional<SweepRun> runItem(const Config& config, const World& world, const SweepItem& item,
                                const std::atomic<bool>& interrupted) {
    Config own = config;
    own.belief.alpha = item.alpha;
    own.seed = item.seed;
    PlanningProblem plan(own, world);
    const PlanOutcome outcome = plan.solve(item.planner, interrupted);
    if (interrupted) return std::nullopt;
    SweepRun run{item,
                 kNone,
                 kNone,
                 kNone,
                 kNone,
                 outcome.vertices,
                 outcome.views,
                 outcome.planSeconds,
                 plan.statusOf(outcome),
                 {}};
    if (outcome.path) setPath(run, *outcome.path);
    return run;
}

void setPath(SweepRun& run, const EvaluatedPath& path) {
    run.cost = path.cost;
    run.length = path.length;
    run.meanTrace = path.meanTrace;
    run.goalTrace = path.goalTrace;
    for (const BeliefPoint& point : path.points) {
        if (point.isWaypoint) run.path.push_back({point.T_w_b.translation(), yawOf(point.T_w_b)});
    }
}

void runItems(const Config& config, const World& world, const std::vector<SweepItem>& items,
              unsigned jobs, const std::atomic<bool>& interrupted,
              const std::function<void(const SweepRun&)>& onRun) {
    std::mutex mutex;  // of onRun
    workInOrder(items.size(), jobs, [&](std::size_t i) {
        if (interrupted) return false;
        const auto run = runUnlessStopped(config, world, items[i], interrupted);
        if (!run) return false;
        const std::lock_guard lock(mutex);
        onRun(*run);
        return true;
    });
}

}  // namespace photonav
