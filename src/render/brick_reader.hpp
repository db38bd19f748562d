// SPDX-License-Identifier: BSD-3-Clause
// Reads bricks of 4 x 4 x 4 cells from an octree.
#pragma once

#include "render/brick_surface.hpp"

namespace photonav {

struct BrickContent {
    BrickSurface surface;       ///< without `exposed`, which depends on the neighbours
    std::uint64_t present = 0;  ///< cells that the map has; the others are unknown
};

/// @param node of the size of a brick, or a larger leaf
BrickContent readBrick(const TexturedOcTree& map, const TexturedOcTreeNode& node);

/// @param brick index in the world, as in MapChange
BrickContent readBrick(const TexturedOcTree& map, const Eigen::Array3i& brick);

}  // namespace photonav
