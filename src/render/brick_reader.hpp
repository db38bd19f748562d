// SPDX-License-Identifier: BSD-3-Clause
// Reads bricks of 4 x 4 x 4 cells from an octree.
#pragma once

#include "render/brick_surface.hpp"

namespace photonav {

/// The content of a brick of the map.
struct BrickContent {
    BrickSurface surface;       ///< without `exposed`, which depends on the neighbours
    std::uint64_t present = 0;  ///< mask of the known cells (free or occupied)
};

/// Reads the brick of a node.
/// @param node of the size of a brick, or a larger leaf that contains the brick
BrickContent readBrick(const TexturedOcTree& map, const TexturedOcTreeNode& node);

/// Reads a brick; it is empty if all of its cells are unknown.
/// @param brick index in the world, as in MapChange
BrickContent readBrick(const TexturedOcTree& map, const Eigen::Array3i& brick);

}  // namespace photonav
