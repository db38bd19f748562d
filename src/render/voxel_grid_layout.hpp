// SPDX-License-Identifier: BSD-3-Clause
// Where the cells of a grid lie.
#pragma once

#include <vector>

#include "render/voxel_grid.hpp"

namespace photonav {

/// The bounding box of a map's cells, world indices; empty for an empty map.
CellBox boundingBox(const TexturedOcTree& map);

/// Makes `box` (world indices) the box of the grid. Where it does not fit, the grid is laid out
/// anew around it, with room to grow if it was laid out before, and keeps its bricks, but not their
/// empty boxes.
/// @returns whether it was laid out anew
/// @throws std::invalid_argument when the box has more than 2^31 cells
bool layOut(const CellBox& box, VoxelGrid& grid);

/// Appends the bricks that hold cells of a box.
void addBricks(const CellBox& box, std::vector<Eigen::Array3i>& bricks);

}  // namespace photonav
