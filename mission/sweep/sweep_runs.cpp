// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_runs.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <mutex>

#include "geometry/constants.hpp"
#include "render/interruptible_views.hpp"

namespace photonav {
namespace {

std::optional<SweepRun> runUnlessStopped(const Config& config, const World& world,
                                         const SweepItem& item,
                                         const std::atomic<bool>& interrupted) {
    try {
        return runItem(config, world, item, interrupted);
    } catch (const RenderingStopped&) {
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
        if (point.isWaypoint) run.path.push_back(point.T_w_b.translation());
    }
}

void runItems(const Config& config, const World& world, const std::vector<SweepItem>& items,
              unsigned jobs, const std::atomic<bool>& interrupted,
              const std::function<void(const SweepRun&)>& onRun) {
    std::atomic<std::size_t> next{0};  // in the order of the items, however many threads there are
    std::mutex mutex;                  // of onRun
    const auto work = [&](unsigned) {
        while (!interrupted && !tbb::is_current_task_group_canceling()) {
            const std::size_t i = next++;
            if (i >= items.size()) return;
            const auto run = runUnlessStopped(config, world, items[i], interrupted);
            if (!run) return;
            const std::lock_guard lock(mutex);
            onRun(*run);
        }
    };
    tbb::task_arena threads(static_cast<int>(jobs));
    threads.execute([&] { tbb::parallel_for(0U, jobs, 1U, work, tbb::simple_partitioner{}); });
}

}  // namespace photonav
