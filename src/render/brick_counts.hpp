// SPDX-License-Identifier: BSD-3-Clause
// Tests whether boxes of cells contain marked cells, by counts of the bricks with marked cells.
#pragma once

#include <cstdint>
#include <vector>

#include "render/voxel_grid.hpp"

namespace photonav {

/// One mask of marked cells per brick, as in VoxelGrid::ends, for a box of bricks.
struct BrickMasks {
    CellBox bricks;
    const std::uint64_t* masks;

    const std::uint64_t* at(const Eigen::Array3i& brick) const {
        const Eigen::Array3i i = brick - bricks.low, n = bricks.high - bricks.low;
        return masks + (std::size_t(i.z()) * n.y() + i.y()) * n.x() + i.x();
    }
};

/// The cells of a grid that end rays.
inline BrickMasks endMasks(const VoxelGrid& grid) {
    return {{Eigen::Array3i::Zero(), grid.bricks}, grid.ends.data()};
}

/// Counts the bricks with marked cells in any box of bricks, by a summed-area table.
class BrickCounts {
  public:
    /// @param bricks box of bricks that can be counted, within masks.bricks
    BrickCounts(const BrickMasks& masks, const CellBox& bricks)
        : bricks_(bricks), size_(bricks.high - bricks.low + 1) {
        sums_.assign(std::size_t(size_.x()) * size_.y() * size_.z(), 0);
        for (int z = 1; z < size_.z(); ++z) {
            for (int y = 1; y < size_.y(); ++y) {
                const std::uint64_t* mask = masks.at(bricks.low + Eigen::Array3i(0, y - 1, z - 1));
                const std::size_t row = at({0, y, z});
                const std::size_t rowBehind = row - size_.x(), below = at({0, y, z - 1}),
                                  belowBehind = below - size_.x();
                std::int32_t inRow = 0;
                for (int x = 1; x < size_.x(); ++x) {
                    inRow += mask[x - 1] != 0 ? 1 : 0;
                    sums_[row + x] =
                        inRow + sums_[rowBehind + x] + sums_[below + x] - sums_[belowBehind + x];
                }
            }
        }
    }

    /// Number of bricks with marked cells in a box of bricks.
    std::int32_t operator()(const CellBox& bricks) const {
        const CellBox part = bricks.clippedTo(bricks_);
        if (part.empty()) return 0;
        const Eigen::Array3i low = part.low - bricks_.low, high = part.high - bricks_.low;
        const auto column = [&](int x, int y) {
            return sums_[at({x, y, high.z()})] - sums_[at({x, y, low.z()})];
        };
        return column(high.x(), high.y()) - column(low.x(), high.y()) - column(high.x(), low.y()) +
               column(low.x(), low.y());
    }

  private:
    std::size_t at(const Eigen::Array3i& i) const {
        return (std::size_t(i.z()) * size_.y() + i.y()) * size_.x() + i.x();
    }

    CellBox bricks_;
    Eigen::Array3i size_;
    std::vector<std::int32_t> sums_;
};

/// Whether a box contains marked cells.
inline bool anyInside(const CellBox& cells, const BrickMasks& masks, const BrickCounts& counts) {
    const CellBox bricks = bricksOf(cells).clippedTo(masks.bricks);
    if (counts(bricks) == 0) return false;
    // Looking at so many bricks takes no longer than counting them.
    constexpr int kMostToScan = 8;
    for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
        CellBox part = bricks;
        part.low.z() = z;
        part.high.z() = z + 1;
        if (counts(part) == 0) continue;
        for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
            part.low.y() = y;
            part.high.y() = y + 1;
            if (bricks.high.x() - bricks.low.x() > kMostToScan && counts(part) == 0) continue;
            const std::uint64_t* mask = masks.at(part.low);
            for (int x = bricks.low.x(); x < bricks.high.x(); ++x, ++mask) {
                if (*mask != 0 && (*mask & cellsInside(cells, {x, y, z})) != 0) return true;
            }
        }
    }
    return false;
}

}  // namespace photonav
