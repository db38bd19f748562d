// SPDX-License-Identifier: BSD-3-Clause
// A quick answer to "is my path still free?", before clearance and plan are updated.
#pragma once

#include <vector>

#include "map/map_change.hpp"
#include "map/textured_octree.hpp"

namespace photonav {

/// Whether a change of the map has put an obstacle on a path of straight legs. Only cells in
/// bricks whose occupancy changed are looked at, so that the answer takes about a millisecond; a
/// path that was free before and is not blocked by the change is free. Conservative: true where the
/// sphere around an occupied cell comes within the radius.
/// @param map after the change
/// @param waypoints of the path ahead, world frame [m]; one: the place where the robot is
/// @param radius of the robot [m]
bool blocksPath(const TexturedOcTree& map, const MapChange& change,
                const std::vector<Eigen::Vector3d>& waypoints, double radius);

}  // namespace photonav
