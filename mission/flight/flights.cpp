// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flights.hpp"

#include <mutex>

#include "render/interruptible_views.hpp"
#include "runs/work_items.hpp"

namespace photonav {

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
    const auto flyOne = [&](std::size_t number) {
        if (interrupted) return false;
        FlightOptions own = options;
        own.robot.camera.isStopped = isStopped;
        own.seed = (options.seed << 32) + number;
        FlightResult& flight = flights[number];
        try {
            flight = fly(plan, stoppable, own, isStopped, number == 0 ? onExposure : OnExposure{});
        } catch (const Interrupted&) {
            return false;
        }
        flight.number = number;
        if (!onFlight || flight.end == FlightEnd::stopped) return true;
        const std::lock_guard lock(mutex);
        onFlight(flight);
        return true;
    };
    workInOrder(count, jobs, flyOne);
    std::erase_if(flights, [](const FlightResult& f) { return f.end == FlightEnd::stopped; });
    return flights;
}

}  // namespace photonav
