// SPDX-License-Identifier: BSD-3-Clause
// A quick check whether a change of the map blocks a path, before clearance and plan are updated.
#pragma once

#include <vector>

#include "map/map_change.hpp"
#include "map/textured_octree.hpp"

namespace photonav {

/// Whether a change of the map has put an obstacle on a path of straight legs. Only cells in bricks
/// whose occupancy changed are checked, which takes about a millisecond; a path that was free
/// before and is not blocked by the change is free. Conservative: true if the bounding sphere of an
/// occupied cell comes closer to the path than the radius.
/// @param map after the change
/// @param waypoints positions of the path ahead, world frame [m]; a single one is the position of
///        the robot; none: the result is false
/// @param radius of the robot [m]
bool blocksPath(const TexturedOcTree& map, const MapChange& change,
                const std::vector<Eigen::Vector3d>& waypoints, double radius);

}  // namespace photonav
