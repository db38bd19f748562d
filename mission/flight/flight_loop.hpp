// SPDX-License-Identifier: BSD-3-Clause
// Robot, tracker and pilot in closed loop.
#pragma once

#include <functional>
#include <vector>

#include "control/pilot.hpp"
#include "robot/robot.hpp"

namespace photonav {

/// Called after every step, with what was measured in it and the images of that as they were
/// tracked. @return whether to fly on
using OnFlightStep =
    std::function<bool(const Observation& observation, const std::vector<TrackedFrame>& tracked)>;

/// robot -> tracker -> pilot -> robot, until `onStep` ends the flight. The first step only looks.
/// @param timeStep between commands [s]
/// @throws std::invalid_argument for a time step that is not positive
void flyLoop(Robot& robot, Tracker& tracker, Pilot& pilot, double timeStep,
             const OnFlightStep& onStep);

}  // namespace photonav
