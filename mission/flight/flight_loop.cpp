// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_loop.hpp"

#include <stdexcept>

namespace photonav {

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
