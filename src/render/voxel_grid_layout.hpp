// SPDX-License-Identifier: BSD-3-Clause
// Where the cells of a grid lie.
#pragma once

#include <vector>

#include "render/voxel_grid.hpp"

namespace photonav {

/// The bounding box of a map's cells, world indices; empty for an empty map.
CellBox boundingBox(const TexturedOcTree& map);

/// Makes `box` (world indices) the box of the grid. Where it does not fit, the grid is moved to a
/// larger space, with room to grow if it had any before.
/// @throws std::invalid_argument when the box has more than 2^31 cells
void layOut(const CellBox& box, VoxelGrid& grid);

/// Moves the grid to a space of whole bricks (world indices) around the one it has, with all that
/// it holds but VoxelGrid::box. In new bricks no cell ends rays, and they have no box.
void moveTo(const CellBox& space, VoxelGrid& grid);

/// Appends the bricks that hold cells of a box.
void addBricks(const CellBox& box, std::vector<Eigen::Array3i>& bricks);

}  // namespace photonav
