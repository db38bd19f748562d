// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace photonav {
namespace {

using Eigen::Array3i;

VoxelGrid emptyGrid(const Array3i& bricks) {
    VoxelGrid grid;
    grid.bricks = bricks;
    grid.size = 4 * bricks;
    grid.ends.assign(bricks.prod(), 0);
    findBoxes(grid);
    return grid;
}

bool endsAt(const VoxelGrid& grid, const Array3i& cell) {
    return (grid.ends[grid.brickIndex(cell / 4)] >> surfaceBit(cell.x(), cell.y(), cell.z()) &
            1U) != 0;
}

void flip(VoxelGrid& grid, const Array3i& cell) {
    grid.ends[grid.brickIndex(cell / 4)] ^= 1ULL << surfaceBit(cell.x(), cell.y(), cell.z());
}

/// Flips cells of different bricks. @returns as updateBoxes()
CellBox flipAndUpdate(VoxelGrid& grid, const std::vector<Array3i>& cells) {
    std::vector<ChangedBrick> changed;
    for (const Array3i& cell : cells) {
        const Array3i brick = cell / 4;
        const bool isListed = std::any_of(changed.begin(), changed.end(), [&](const auto& other) {
            return (other.brick == brick).all();
        });
        if (isListed) continue;
        changed.push_back({brick, grid.ends[grid.brickIndex(brick)]});
        flip(grid, cell);
    }
    return updateBoxes(grid, changed);
}

template <class Visit>
void visitAll(const Array3i& low, const Array3i& high, const Visit& visit) {
    for (int z = low.z(); z < high.z(); ++z) {
        for (int y = low.y(); y < high.y(); ++y) {
            for (int x = low.x(); x < high.x(); ++x) visit(Array3i(x, y, z));
        }
    }
}

/// Every box holds only cells that do not end rays, some of them in its brick, and no brick that
/// has whole empty layers at one of its sides is without.
void expectValidBoxes(const VoxelGrid& grid) {
    visitAll({0, 0, 0}, grid.bricks, [&](const Array3i& brick) {
        const CellBox box = emptyBoxOf(grid, brick);
        const std::uint64_t ends = grid.ends[grid.brickIndex(brick)];
        const std::uint64_t within = cellsInside(box, brick);
        EXPECT_EQ(box.empty(), within == 0);
        EXPECT_EQ(within == ~0ULL, ends == 0);
        EXPECT_EQ(grid.boxes[grid.brickIndex(brick)].restEnds != 0, (ends | within) == ~0ULL);
        if (box.empty()) {
            EXPECT_NE(ends & 0xFFFFU, 0U);
            return;
        }
        EXPECT_TRUE((CellBox{Array3i::Zero(), grid.size}.contains(box)));
        visitAll(box.low, box.high, [&](const Array3i& cell) { EXPECT_FALSE(endsAt(grid, cell)); });
    });
}

bool isEqual(const EmptyBox& a, const EmptyBox& b) {
    return a.before == b.before && a.after == b.after && a.restEnds == b.restEnds;
}

TEST(VoxelBoxes, MasksOfCellsAgreeWithAPlainTest) {
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const auto within = [&](int n) { return static_cast<int>(random() % n); };
        const CellBox box{{within(12), within(12), within(12)},
                          {within(13), within(13), within(13)}};
        std::uint64_t expected = 0;
        visitAll({4, 4, 4}, {8, 8, 8}, [&](const Array3i& c) {
            const bool inside = (c >= box.low).all() && (c < box.high).all();
            if (inside) expected |= 1ULL << surfaceBit(c.x(), c.y(), c.z());
        });
        EXPECT_EQ(cellsInside(box, {1, 1, 1}), expected);
    }
}

TEST(VoxelBoxes, HoldOnlyEmptyCells) {
    for (const unsigned cells : {0U, 3U, 40U, 2000U}) {
        VoxelGrid grid = emptyGrid({9, 7, 5});
        std::mt19937 random(cells);
        for (unsigned i = 0; i < cells; ++i) {
            flip(grid, Array3i(random() % 36, random() % 28, random() % 20));
        }
        findBoxes(grid);
        expectValidBoxes(grid);
    }
}

TEST(VoxelBoxes, FillARoomDownToItsFloor) {
    VoxelGrid grid = emptyGrid({100, 20, 6});
    visitAll({0, 0, 0}, {400, 80, 2}, [&](const Array3i& cell) { flip(grid, cell); });
    findBoxes(grid);
    const CellBox middle = emptyBoxOf(grid, {50, 10, 3});
    EXPECT_TRUE((middle.low <= Array3i(0, 0, 2)).all());
    EXPECT_TRUE((middle.high >= Array3i(400, 80, 24)).all());
    const CellBox onFloor = emptyBoxOf(grid, {50, 10, 0});
    EXPECT_TRUE((onFloor.low == middle.low).all() && (onFloor.high == middle.high).all());
    // As far as a byte can say.
    EXPECT_EQ(emptyBoxOf(grid, {0, 0, 3}).high.x(), EmptyBox::kFurthest);
}

TEST(VoxelBoxes, StayValidAfterAnyChanges) {
    VoxelGrid grid = emptyGrid({9, 7, 5});
    std::mt19937 random(3);
    for (int step = 0; step < 60; ++step) {
        std::vector<Array3i> cells;
        for (unsigned i = 0; i <= random() % 4; ++i) {
            cells.emplace_back(random() % 36, random() % 28, random() % 20);
        }
        const std::vector<EmptyBox> before = grid.boxes;
        const CellBox rewritten = flipAndUpdate(grid, cells);
        expectValidBoxes(grid);
        visitAll({0, 0, 0}, grid.bricks, [&](const Array3i& brick) {
            if (rewritten.contains({brick, brick + 1})) return;
            const std::size_t index = grid.brickIndex(brick);
            EXPECT_TRUE(isEqual(before[index], grid.boxes[index]));
        });
        ASSERT_FALSE(HasFailure()) << "step " << step;
    }
}

TEST(VoxelBoxes, GrowAgainWhereAnObstacleGoes) {
    VoxelGrid grid = emptyGrid({80, 4, 4});
    const Array3i obstacle(100, 8, 8);
    flipAndUpdate(grid, {obstacle});
    const CellBox cut = emptyBoxOf(grid, {2, 2, 2});
    EXPECT_TRUE(cut.high.x() <= 100 || cut.high.y() <= 8 || cut.high.z() <= 8);
    flipAndUpdate(grid, {obstacle});
    EXPECT_TRUE((emptyBoxOf(grid, {2, 2, 2}).high == Array3i(260, 16, 16)).all());
}

}  // namespace
}  // namespace photonav
