// SPDX-License-Identifier: BSD-3-Clause
// The space that the cells of a grid cover.
#pragma once

#include <vector>

#include "render/voxel_grid.hpp"

namespace photonav {

/// The bounding box of a map's cells, world indices; empty for an empty map.
CellBox boundingBox(const TexturedOcTree& map);

/// Makes `box` (world indices) the box of the grid. If the box does not fit into the grid's space,
/// the grid is moved to a larger space; a grid that was not empty gets additional space to grow.
/// @throws MapTooLarge when the box has more than 2^31 cells
void layOut(const CellBox& box, VoxelGrid& grid);

/// Moves the grid to another space of whole bricks (world indices), with its content there except
/// VoxelGrid::box. In new bricks no cell ends rays, and they have no empty box.
void moveTo(const CellBox& space, VoxelGrid& grid);

/// Appends the bricks that contain cells of a box to a list.
void addBricks(const CellBox& box, std::vector<Eigen::Array3i>& bricks);

}  // namespace photonav
