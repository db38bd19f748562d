// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_loop.hpp"

#include <stdexcept>
#include <utility>

namespace photonav {

Tracker trackerOf(const Robot& robot, std::shared_ptr<const ViewSource> map,
                  const UncertainPose& start, TrackerOptions options) {
    options.T_b_c = robot.T_b_c();
    options.map.blur = robot.blur();
    return {std::move(map), robot.camera(), start, options};
}

Pilot pilotOf(const Robot& robot, std::vector<PlannedView> plan,
              std::shared_ptr<const ViewSource> map, const PilotOptions& options) {
    return {std::move(plan), std::move(map), robot.camera(), robot.T_b_c(), options};
}

void flyLoop(Robot& robot, Tracker& tracker, Pilot& pilot, double timeStep,
             const OnFlightStep& onStep) {
    if (!(timeStep > 0.)) throw std::invalid_argument("flight: the time step must be positive");
    BodyVelocity command;
    for (double seconds = 0.;; seconds = timeStep) {
        const Observation observation = robot.fly(command, seconds);
        const std::vector<TrackedFrame> tracked = tracker.update(observation);
        for (std::size_t i = 0; i < tracked.size(); ++i) {
            pilot.observe(tracker, tracked[i], observation.frames[i].view.intensity);
        }
        if (!onStep(observation, tracked)) return;
        command = pilot.command(tracker, observation.time, timeStep);
    }
}

}  // namespace photonav
