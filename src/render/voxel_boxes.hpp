// SPDX-License-Identifier: BSD-3-Clause
// Finds the empty boxes of a grid, which rays cross in one step.
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

/// Finds all boxes of a grid.
void findBoxes(VoxelGrid& grid);

/// A brick whose VoxelGrid::ends has changed.
struct ChangedBrick {
    Eigen::Array3i brick;
    std::uint64_t before;  ///< VoxelGrid::ends before the change
};

/// Updates the boxes of a grid after a change: the boxes of the changed bricks, boxes that are not
/// empty any more, and boxes beside bricks that have become empty. All other boxes stay valid, but
/// may be smaller than those of findBoxes(): rays then take more steps, and views do not change.
/// @param changed each brick at most once
/// @returns the bricks whose boxes may have changed, as a box of bricks
CellBox updateBoxes(VoxelGrid& grid, const std::vector<ChangedBrick>& changed);

}  // namespace photonav
