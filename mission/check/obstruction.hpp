// SPDX-License-Identifier: BSD-3-Clause
// Where a trajectory is in collision or out of bounds.
#pragma once

#include <vector>

#include "check/given_trajectory.hpp"
#include "config/config.hpp"
#include "problem/world.hpp"

namespace photonav {

/// A part of a trajectory, by the way of the position so far.
struct Stretch {
    double begin = 0., end = 0.;  ///< [m]
};

struct Obstruction {
    std::vector<Stretch> collisions = {};  ///< nearer to an obstacle than the robot's radius
    std::vector<Stretch> outside = {};     ///< of the bounds of the config
    double leastClearance = 0.;  ///< within the bounds; at most World::clearance() reaches [m]
};

/// Looks at every 2 cm of the straight motions between the poses, and at the poses themselves.
Obstruction obstructionOf(const GivenTrajectory& trajectory, const Config& config,
                          const World& world);

}  // namespace photonav
