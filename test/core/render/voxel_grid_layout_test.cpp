// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_grid_layout.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

using Eigen::Array3i;

/// Each brick's `ends` is a number of its place in the world.
std::uint64_t numberOf(const Array3i& brick) {
    return static_cast<std::uint64_t>(brick.x() + 100 * brick.y() + 10000 * brick.z() + 1);
}

/// A grid of 5 x 4 x 3 bricks that begins at brick (10, 20, 30).
VoxelGrid numberedGrid() {
    VoxelGrid grid;
    moveTo({Array3i(40, 80, 120), Array3i(60, 96, 132)}, grid);
    for (int z = 0; z < 3; ++z) {
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 5; ++x) {
                grid.ends[grid.brickIndex({x, y, z})] = numberOf({x + 10, y + 20, z + 30});
            }
        }
    }
    return grid;
}

/// Where the maps of large scenes are near the largest size, the space of a grid loses its spare
/// cells on one side when it grows on the other.
TEST(VoxelGridLayout, KeepsWhatTheOldSpaceAndTheNewOneShare) {
    const CellBox old{Array3i(10, 20, 30), Array3i(15, 24, 33)};  // bricks
    for (const CellBox& bricks : {CellBox{Array3i(8, 18, 29), Array3i(17, 26, 35)},
                                  CellBox{Array3i(12, 18, 31), Array3i(20, 23, 32)},
                                  CellBox{Array3i(11, 21, 31), Array3i(13, 22, 33)},
                                  CellBox{Array3i(40, 50, 60), Array3i(42, 52, 62)}}) {
        VoxelGrid grid = numberedGrid();
        moveTo({4 * bricks.low, 4 * bricks.high}, grid);
        ASSERT_EQ(grid.ends.size(), static_cast<std::size_t>((bricks.high - bricks.low).prod()));
        for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
            for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
                for (int x = bricks.low.x(); x < bricks.high.x(); ++x) {
                    const Array3i brick(x, y, z);
                    const bool isOld = old.contains({brick, brick + 1});
                    EXPECT_EQ(grid.ends[grid.brickIndex(brick - bricks.low)],
                              isOld ? numberOf(brick) : 0U);
                }
            }
        }
    }
}

}  // namespace
}  // namespace photonav
