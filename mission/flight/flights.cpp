// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flights.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <mutex>

#include "render/interruptible_views.hpp"

namespace photonav {

std::vector<PlannedView> plannedViews(std::span<const BeliefPoint> path) {
    std::vector<PlannedView> plan;
    for (const BeliefPoint& point : path) {
        plan.push_back({point.T_w_b, point.covariance, point.length, point.isWaypoint});
    }
    return plan;
}

std::vector<FlightResult> flyMany(const std::vector<PlannedView>& plan, const FlightWorld& world,
                                  const FlightOptions& options, unsigned count, unsigned jobs,
                                  const std::atomic<bool>& interrupted,
                                  const std::function<void(const FlightResult&)>& onFlight,
                                  const OnExposure& onExposure) {
    std::vector<FlightResult> flights(count);
    std::mutex mutex;  // of onFlight
    const auto isStopped = [&] { return interrupted.load(); };
    FlightWorld stoppable = world;
    if (world.truth) stoppable.truth = std::make_shared<InterruptibleViews>(world.truth, isStopped);
    if (world.map) stoppable.map = std::make_shared<InterruptibleViews>(world.map, isStopped);
    const auto flyOne = [&](unsigned number) {
        if (interrupted) return;
        FlightOptions own = options;
        own.seed = (options.seed << 32) + number;
        FlightResult& flight = flights[number];
        try {
            flight = fly(plan, stoppable, own, isStopped, number == 0 ? onExposure : OnExposure{});
        } catch (const RenderingStopped&) {
            return;
        }
        flight.number = number;
        if (!onFlight || flight.end == FlightEnd::stopped) return;
        const std::lock_guard lock(mutex);
        onFlight(flight);
    };
    tbb::task_arena arena(static_cast<int>(jobs));
    arena.execute([&] { tbb::parallel_for(0U, count, 1U, flyOne, tbb::simple_partitioner{}); });
    std::erase_if(flights, [](const FlightResult& f) { return f.end == FlightEnd::stopped; });
    return flights;
}

}  // namespace photonav
