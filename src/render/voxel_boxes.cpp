// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_boxes.hpp"

#include <algorithm>
#include <optional>

namespace photonav {
namespace {

using Eigen::Array3i;

/// A mask of the bits [from, to) of a row of four cells.
std::uint64_t fourBits(int from, int to) { return (1ULL << to) - (1ULL << from); }

std::uint64_t bitsBelow(int count) { return count < 64 ? (1ULL << count) - 1 : ~0ULL; }

/// Counts marked bricks in boxes of bricks: a summed-area table of a part of the grid.
class BrickCounts {
  public:
    /// @param marked whether a brick counts, by its index
    template <class Marked>
    BrickCounts(const VoxelGrid& grid, const CellBox& bricks, const Marked& marked)
        : bricks_(bricks), size_(bricks.high - bricks.low + 1) {
        sums_.assign(std::size_t(size_.x()) * size_.y() * size_.z(), 0);
        for (int z = 1; z < size_.z(); ++z) {
            for (int y = 1; y < size_.y(); ++y) {
                const std::size_t brick = grid.brickIndex(bricks.low + Array3i(0, y - 1, z - 1));
                const std::size_t row = at({0, y, z});
                const std::size_t rowBehind = row - size_.x(), below = at({0, y, z - 1}),
                                  belowBehind = below - size_.x();
                std::int32_t inRow = 0;
                for (int x = 1; x < size_.x(); ++x) {
                    inRow += marked(brick + x - 1) ? 1 : 0;
                    sums_[row + x] =
                        inRow + sums_[rowBehind + x] + sums_[below + x] - sums_[belowBehind + x];
                }
            }
        }
    }

    std::int32_t operator()(const CellBox& bricks) const {
        const CellBox part = bricks.clippedTo(bricks_);
        if (part.empty()) return 0;
        const Array3i low = part.low - bricks_.low, high = part.high - bricks_.low;
        const auto column = [&](int x, int y) {
            return sums_[at({x, y, high.z()})] - sums_[at({x, y, low.z()})];
        };
        return column(high.x(), high.y()) - column(low.x(), high.y()) - column(high.x(), low.y()) +
               column(low.x(), low.y());
    }

  private:
    std::size_t at(const Array3i& i) const {
        return (std::size_t(i.z()) * size_.y() + i.y()) * size_.x() + i.x();
    }

    CellBox bricks_;
    Array3i size_;
    std::vector<std::int32_t> sums_;
};

EmptyBox encoded(const CellBox& box, const Array3i& brick, std::uint64_t ends) {
    EmptyBox stored;
    if (!box.empty()) {
        const Array3i before = 4 * brick + 3 - box.low, after = box.high - 4 * brick;
        for (int a = 0; a < 3; ++a) {
            stored.before[a] = static_cast<std::uint8_t>(before[a]);
            stored.after[a] = static_cast<std::uint8_t>(after[a]);
        }
    }
    if ((ends | (box.empty() ? 0 : cellsInside(box, brick))) == ~0ULL) stored.restEnds = 128;
    return stored;
}

/// The thickest layer of a brick, at one of its sides, without cells that end rays.
CellBox emptyLayer(std::uint64_t ends, const Array3i& brick) {
    const CellBox cells = cellsOf(brick);
    if (ends == 0) return cells;
    if (ends == ~0ULL) return {};
    for (int thickness = 3; thickness > 0; --thickness) {
        for (int axis = 2; axis >= 0; --axis) {
            CellBox low = cells, high = cells;
            low.high[axis] = cells.low[axis] + thickness;
            high.low[axis] = cells.high[axis] - thickness;
            if ((ends & cellsInside(high, brick)) == 0) return high;
            if ((ends & cellsInside(low, brick)) == 0) return low;
        }
    }
    return {};
}

class BoxFinder {
  public:
    /// @param around the bricks whose boxes are to be found lie in this box of bricks
    BoxFinder(VoxelGrid& grid, const CellBox& around)
        : grid_(grid),
          cells_{Array3i::Zero(), grid.size},
          full_(grid,
                around.grown(EmptyBox::kFurthest / 4)
                    .clippedTo({Array3i::Zero(), Array3i(grid.bricks)}),
                [&](std::size_t brick) { return grid.ends[brick] != 0; }) {}

    /// Finds the box of a brick. Neighbours have valid boxes, or of size 0.
    void find(const Array3i& brick) {
        const std::size_t index = grid_.brickIndex(brick);
        const CellBox layer = emptyLayer(grid_.ends[index], brick);
        CellBox box;
        if (!layer.empty()) box = largestAround(layer, brick);
        if (!box.empty()) {
            extendReach(box, brick);
        } else if (!layer.empty()) {
            box = grow(layer, brick);
        }
        grid_.boxes[index] = encoded(box, brick, grid_.ends[index]);
    }

  private:
    /// The largest box of the neighbours that holds a layer of a brick, or an empty one. Most
    /// bricks share a box with their neighbours.
    CellBox largestAround(const CellBox& layer, const Array3i& brick) const {
        CellBox largest;
        double most = 0.;
        const CellBox limit = limits(brick);
        for (int side = 0; side < 6; ++side) {
            Array3i neighbour = brick;
            neighbour[side / 2] += side % 2 == 0 ? -1 : 1;
            if ((neighbour < 0).any() || (neighbour >= grid_.bricks).any()) continue;
            const CellBox box = emptyBoxOf(grid_, neighbour).clippedTo(limit);
            if (!box.contains(layer)) continue;
            const double volume = (box.high - box.low).cast<double>().prod();
            if (volume <= most) continue;
            most = volume;
            largest = box;
        }
        return largest;
    }

    /// Extends a neighbour's box where it is as long as the neighbour can store.
    void extendReach(CellBox& box, const Array3i& brick) const {
        constexpr int kReach = EmptyBox::kFurthest - 4;
        for (int axis = 0; axis < 3; ++axis) {
            const int first = 4 * brick[axis];
            if (box.low[axis] == first - kReach) extend(box, 2 * axis, 4, limits(brick));
            if (box.high[axis] == first + kReach) extend(box, 2 * axis + 1, 4, limits(brick));
        }
    }

    /// The cells that the box of a brick can reach.
    CellBox limits(const Array3i& brick) const {
        return CellBox{4 * brick - EmptyBox::kFurthest, 4 * brick + EmptyBox::kFurthest}.clippedTo(
            cells_);
    }

    /// Grows a box to all sides in turn, at first by whole bricks, more and more at a time.
    CellBox grow(CellBox box, const Array3i& brick) const {
        const CellBox limit = limits(brick);
        std::array<bool, 6> grows;
        grows.fill(true);
        for (int step = 4; step <= 128; step *= 2) {
            for (int side = 0; side < 6; ++side) {
                grows[side] = grows[side] && extend(box, side, step, limit);
            }
        }
        for (int step = 128; step > 0; step /= 2) {
            for (int side = 0; side < 6; ++side) {
                while (extend(box, side, step, limit)) {
                }
            }
        }
        return box;
    }

    /// Extends a box to one side by `step` cells, if they are empty and within the limit.
    bool extend(CellBox& box, int side, int step, const CellBox& limit) const {
        const int axis = side / 2;
        CellBox more = box;
        if (side % 2 == 0) {
            more.high[axis] = box.low[axis];
            more.low[axis] = std::max(limit.low[axis], box.low[axis] - step);
        } else {
            more.low[axis] = box.high[axis];
            more.high[axis] = std::min(limit.high[axis], box.high[axis] + step);
        }
        if (more.empty() || !isEmpty(more)) return false;
        box.extend(more);
        return true;
    }

    bool isEmpty(const CellBox& cells) const {
        const CellBox bricks = bricksOf(cells);
        if (full_(bricks) == 0) return true;
        for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
            for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
                const CellBox row{{bricks.low.x(), y, z}, {bricks.high.x(), y + 1, z + 1}};
                if (full_(row) == 0) continue;
                for (int x = bricks.low.x(); x < bricks.high.x(); ++x) {
                    const std::uint64_t ends = grid_.ends[grid_.brickIndex({x, y, z})];
                    if (ends != 0 && (ends & cellsInside(cells, {x, y, z})) != 0) return false;
                }
            }
        }
        return true;
    }

    VoxelGrid& grid_;
    CellBox cells_;
    BrickCounts full_;
};

/// Calls `visit` for every brick in a box of bricks, x fastest.
template <class Visit>
void visitBricks(const CellBox& bricks, const Visit& visit) {
    for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
        for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
            for (int x = bricks.low.x(); x < bricks.high.x(); ++x) visit(Array3i(x, y, z));
        }
    }
}

/// Which empty boxes a change of the grid affects.
class Affected {
  public:
    Affected(const VoxelGrid& grid, const std::vector<ChangedBrick>& changed)
        : grid_(grid), changed_(changed) {
        for (const ChangedBrick& change : changed) {
            around_.extend({change.brick, change.brick + 1});
        }
        std::vector<std::uint8_t> kinds(grid.ends.size(), 0);
        for (const ChangedBrick& change : changed) {
            const std::size_t index = grid.brickIndex(change.brick);
            if ((grid.ends[index] & ~change.before) != 0) kinds[index] = kFilled;
            if (grid.ends[index] == 0) kinds[index] = kEmptied;
        }
        filled_.emplace(grid, around_, [&](std::size_t i) { return kinds[i] == kFilled; });
        emptied_.emplace(grid, around_, [&](std::size_t i) { return kinds[i] == kEmptied; });
    }

    /// The changed bricks are in this box of bricks.
    const CellBox& around() const { return around_; }

    /// Neighbouring bricks mostly share a box: the last answer is kept.
    bool operator()(const CellBox& box) {
        if ((box.low != last_.low).any() || (box.high != last_.high).any()) {
            last_ = box;
            isAffected_ = !box.empty() && ((*emptied_)(bricksOf(box.grown(1))) > 0 || isCut(box));
        }
        return isAffected_;
    }

  private:
    /// Whether cells of a box end rays now. With many changes only whether their bricks do.
    bool isCut(const CellBox& box) const {
        const auto quarter = [](int i) { return i >> 2; };
        constexpr std::size_t kMostToTest = 300;
        const CellBox outer = bricksOf(box),
                      inner{(box.low + 3).unaryExpr(quarter), box.high.unaryExpr(quarter)};
        if ((*filled_)(outer) == 0) return false;
        if (changed_.size() > kMostToTest || (*filled_)(inner) > 0) return true;
        return std::any_of(changed_.begin(), changed_.end(), [&](const ChangedBrick& change) {
            const std::uint64_t added = grid_.ends[grid_.brickIndex(change.brick)] & ~change.before;
            return (added & cellsInside(box, change.brick)) != 0;
        });
    }

    static constexpr std::uint8_t kFilled = 1, kEmptied = 2;
    const VoxelGrid& grid_;
    const std::vector<ChangedBrick>& changed_;
    CellBox around_, last_;
    std::optional<BrickCounts> filled_, emptied_;
    bool isAffected_ = false;
};

}  // namespace

std::uint64_t cellsInside(const CellBox& box, const Array3i& brick) {
    const CellBox part = box.clippedTo(cellsOf(brick));
    if (part.empty()) return 0;
    const Array3i low = part.low - 4 * brick, high = part.high - 4 * brick;
    const std::uint64_t x = fourBits(low.x(), high.x()) * 0x1111111111111111ULL;
    const std::uint64_t y = fourBits(4 * low.y(), 4 * high.y()) * 0x0001000100010001ULL;
    return x & y & bitsBelow(16 * high.z()) & ~bitsBelow(16 * low.z());
}

void findBoxes(VoxelGrid& grid) {
    const CellBox all{Array3i::Zero(), grid.bricks};
    grid.boxes.assign(grid.ends.size(), {});
    if (all.empty()) return;
    BoxFinder finder(grid, all);
    visitBricks(all, [&](const Array3i& brick) { finder.find(brick); });
}

CellBox updateBoxes(VoxelGrid& grid, const std::vector<ChangedBrick>& changed) {
    if (changed.empty()) return {};
    Affected isAffected(grid, changed);
    std::vector<Array3i> toFind;
    CellBox rewritten;
    const auto forget = [&](const Array3i& brick) {
        toFind.push_back(brick);
        rewritten.extend({brick, brick + 1});
        grid.boxes[grid.brickIndex(brick)] = {};
    };
    for (const ChangedBrick& change : changed) forget(change.brick);
    const CellBox near = isAffected.around()
                             .grown(EmptyBox::kFurthest / 4)
                             .clippedTo({Array3i::Zero(), Array3i(grid.bricks)});
    visitBricks(near, [&](const Array3i& brick) {
        if (isAffected(emptyBoxOf(grid, brick))) forget(brick);
    });
    BoxFinder finder(grid, rewritten);
    for (const Array3i& brick : toFind) finder.find(brick);
    return rewritten;
}

}  // namespace photonav
