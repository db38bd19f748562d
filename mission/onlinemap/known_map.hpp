// SPDX-License-Identifier: BSD-3-Clause
// The map that a robot knows before it takes off.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "config/config.hpp"
#include "map/textured_octree.hpp"
#include "problem/world.hpp"

namespace photonav {

/// Whether a config gives the robot a map before it takes off: map.file beside scene.file. A config
/// with map.file alone has the map as the true world, which the robot does not know.
inline bool knowsMap(const Config& config) {
    return !config.sceneFile.empty() && !config.mapFile.empty();
}

/// The true world of an exploration: the scene, or the map of a config without scene.
/// @throws InputError as World does
World trueWorld(Config config);

/// The map that the robot knows at take-off; null: none.
/// @throws InputError, as of Config::invalid(), for a map that cannot be read, is empty, has cells
///         of a size that explorations do not have, or of another one than explore.resolution, is
///         farther than explore.range from the bounds, or is too large for views
std::shared_ptr<const TexturedOcTree> loadKnownMap(const Config& config);

/// The bricks (see MapChange) with a leaf that a condition holds for, sorted.
std::vector<Eigen::Array3i> bricksWith(
    const TexturedOcTree& map, const std::function<bool(const TexturedOcTreeNode& leaf)>& holds);

}  // namespace photonav
