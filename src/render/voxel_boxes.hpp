// SPDX-License-Identifier: BSD-3-Clause
// Finds the empty boxes of a grid, which rays leave in one step.
#pragma once

#include <vector>

#include "render/voxel_grid.hpp"

namespace photonav {

/// The empty box that is stored with a brick, in cells of the grid.
inline CellBox emptyBoxOf(const VoxelGrid& grid, const Eigen::Array3i& brick) {
    const EmptyBox& box = grid.boxes[grid.brickIndex(brick)];
    const Eigen::Array3i first = 4 * brick;
    return {first + 3 - Eigen::Array3i(box.before[0], box.before[1], box.before[2]),
            first + Eigen::Array3i(box.after[0], box.after[1], box.after[2])};
}

/// Finds all boxes of a grid anew.
void findBoxes(VoxelGrid& grid);

/// A brick in which cells have begun or ceased to end rays.
struct ChangedBrick {
    Eigen::Array3i brick;
    std::uint64_t before;  ///< VoxelGrid::ends before the change
};

/// Finds anew the boxes in which cells end rays now, those of the changed bricks, and those beside
/// bricks that have become empty. All others stay valid, but may have become smaller than what
/// findBoxes() would find: that costs rays a step, and views do not change.
/// @param changed every brick at most once
/// @returns the bricks whose boxes may have changed, as a box of bricks
CellBox updateBoxes(VoxelGrid& grid, const std::vector<ChangedBrick>& changed);

}  // namespace photonav
