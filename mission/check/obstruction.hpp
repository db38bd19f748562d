// SPDX-License-Identifier: BSD-3-Clause
// Finds where a trajectory is in collision or out of bounds.
#pragma once

#include <vector>

#include "check/given_trajectory.hpp"
#include "config/config.hpp"
#include "problem/interruption_scope.hpp"
#include "problem/world.hpp"

namespace photonav {

/// A part of a trajectory, between two lengths from its beginning.
struct Stretch {
    double begin = 0., end = 0.;  ///< [m]
};

struct Obstruction {
    std::vector<Stretch> collisions = {};  ///< parts nearer to an obstacle than the robot's radius
    /// Parts as near to unknown cells that count as obstacles, but not to an obstacle.
    std::vector<Stretch> unknown = {};
    std::vector<Stretch> outside = {};  ///< parts outside of the bounds of the config
    /// Least clearance within the bounds, limited by the range of World::clearance() [m]; infinite
    /// if all of the trajectory is out of bounds.
    double leastClearance = 0.;
};

/// Checks the poses and the straight motions between them, every 2 cm.
/// @param interrupted when it is set, the rest of the trajectory is left out
Obstruction obstructionOf(const GivenTrajectory& trajectory, const Config& config,
                          const World& world,
                          const std::atomic<bool>& interrupted = kNotInterrupted);

}  // namespace photonav
