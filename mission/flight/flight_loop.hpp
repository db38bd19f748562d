// SPDX-License-Identifier: BSD-3-Clause
// Robot, tracker and pilot in closed loop.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "control/pilot.hpp"
#include "robot/robot.hpp"

namespace photonav {

/// A tracker of the robot's images. Camera, mount and sharpness are the robot's, whatever the
/// options say. @param start belief T_c_w
Tracker trackerOf(const Robot& robot, std::shared_ptr<const ViewSource> map,
                  const UncertainPose& start, TrackerOptions options = {});

/// A pilot of the robot. @param plan at least two views @throws std::invalid_argument otherwise
Pilot pilotOf(const Robot& robot, std::vector<PlannedView> plan,
              std::shared_ptr<const ViewSource> map, const PilotOptions& options = {});

/// Called after every step, with its measurements and the tracking results of its images.
/// @return whether to fly on
using OnFlightStep =
    std::function<bool(const Observation& observation, const std::vector<TrackedFrame>& tracked)>;

/// robot -> tracker -> pilot -> robot, until `onStep` ends the flight. The first step takes images
/// without a motion.
/// @param timeStep between commands [s]
/// @throws std::invalid_argument for a time step that is not positive
void flyLoop(Robot& robot, Tracker& tracker, Pilot& pilot, double timeStep,
             const OnFlightStep& onStep);

}  // namespace photonav
