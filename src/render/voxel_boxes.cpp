// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_boxes.hpp"

#include <algorithm>
#include <optional>

#include "render/brick_counts.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;

/// A mask of the bits [from, to) of a row of four cells.
std::uint64_t fourBits(int from, int to) { return (1ULL << to) - (1ULL << from); }

std::uint64_t bitsBelow(int count) { return count < 64 ? (1ULL << count) - 1 : ~0ULL; }

BrickMasks endMasks(const VoxelGrid& grid) {
    return {{Array3i::Zero(), grid.bricks}, grid.ends.data()};
}

/// The cells beside a box on one side.
CellBox cellsBeside(const CellBox& box, int side, int thickness) {
    const int axis = side / 2;
    CellBox cells = box;
    if (side % 2 == 0) {
        cells.high[axis] = box.low[axis];
        cells.low[axis] = box.low[axis] - thickness;
    } else {
        cells.low[axis] = box.high[axis];
        cells.high[axis] = box.high[axis] + thickness;
    }
    return cells;
}

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

/// Layers of a brick at one of its sides, the thickest first.
struct BrickLayer {
    CellBox box;  ///< of the brick at the origin
    std::uint64_t cells;
};

std::array<BrickLayer, 18> makeLayers() {
    std::array<BrickLayer, 18> layers;
    auto layer = layers.begin();
    for (int thickness = 3; thickness > 0; --thickness) {
        for (int axis = 2; axis >= 0; --axis) {
            CellBox low = cellsOf({0, 0, 0}), high = low;
            low.high[axis] = thickness;
            high.low[axis] = 4 - thickness;
            *layer++ = {high, cellsInside(high, {0, 0, 0})};
            *layer++ = {low, cellsInside(low, {0, 0, 0})};
        }
    }
    return layers;
}

/// The thickest layer of a brick, at one of its sides, without cells that end rays.
CellBox emptyLayer(std::uint64_t ends, const Array3i& brick) {
    static const std::array<BrickLayer, 18> kLayers = makeLayers();
    if (ends == 0) return cellsOf(brick);
    if (ends == ~0ULL) return {};
    for (const BrickLayer& layer : kLayers) {
        if ((ends & layer.cells) == 0)
            return {layer.box.low + 4 * brick, layer.box.high + 4 * brick};
    }
    return {};
}

class BoxFinder {
  public:
    /// @param around the bricks whose boxes are to be found lie in this box of bricks
    BoxFinder(VoxelGrid& grid, const CellBox& around)
        : grid_(grid),
          cells_{Array3i::Zero(), grid.size},
          full_(endMasks(grid), around.grown(EmptyBox::kFurthest / 4)
                                    .clippedTo({Array3i::Zero(), Array3i(grid.bricks)})) {}

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

    /// Grows a box to all sides in turn, at first by whole bricks, more and more at a time. Where a
    /// step was too far, it is so for good, because the box only grows.
    CellBox grow(CellBox box, const Array3i& brick) const {
        const CellBox limit = limits(brick);
        std::array<int, 6> tooFar;
        tooFar.fill(2 * kLongestStep);
        const auto tryStep = [&](int side, int step) {
            if (step < tooFar[side] && extend(box, side, step, limit)) return true;
            tooFar[side] = std::min(tooFar[side], step);
            return false;
        };
        for (int step = 4; step <= kLongestStep; step *= 2) {
            for (int side = 0; side < 6; ++side) tryStep(side, step);
        }
        for (int step = kLongestStep; step > 0; step /= 2) {
            for (int side = 0; side < 6; ++side) {
                while (tryStep(side, step)) {
                }
            }
        }
        return box;
    }

    /// Extends a box to one side by `step` cells, if they are empty and within the limit.
    bool extend(CellBox& box, int side, int step, const CellBox& limit) const {
        const CellBox more = cellsBeside(box, side, step).clippedTo(limit);
        if (more.empty() || anyInside(more, endMasks(grid_), full_)) return false;
        box.extend(more);
        return true;
    }

    static constexpr int kLongestStep = 128;
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
    Affected(const VoxelGrid& grid, const std::vector<ChangedBrick>& changed) : grid_(grid) {
        for (const ChangedBrick& change : changed) {
            around_.extend({change.brick, change.brick + 1});
        }
        const auto bricks = static_cast<std::size_t>((around_.high - around_.low).prod());
        filledMasks_.assign(bricks, 0);
        std::vector<std::uint64_t> emptied(bricks, 0);
        for (const ChangedBrick& change : changed) {
            const std::uint64_t ends = grid.ends[grid.brickIndex(change.brick)];
            const std::ptrdiff_t at = filled().at(change.brick) - filledMasks_.data();
            filledMasks_[at] = ends & ~change.before;
            emptied[at] = ends == 0 ? 1 : 0;
        }
        filledCounts_.emplace(filled(), around_);
        emptiedCounts_.emplace(BrickMasks{around_, emptied.data()}, around_);
    }

    /// The changed bricks are in this box of bricks.
    const CellBox& around() const { return around_; }

    /// Many bricks share a box: answers are kept.
    bool operator()(const CellBox& box) {
        if (bricksOf(box.grown(1)).clippedTo(around_).empty()) return false;
        const Array3i mixed = box.low * Array3i(1, 9, 81) + box.high * Array3i(27, 243, 729);
        Answer& answer = answers_[static_cast<unsigned>(mixed.sum()) % kAnswers];
        if ((box.low != answer.box.low).any() || (box.high != answer.box.high).any()) {
            answer = {box, isCut(box) || mayGrow(box)};
        }
        return answer.isAffected;
    }

  private:
    static constexpr unsigned kAnswers = 256;
    struct Answer {
        CellBox box;
        bool isAffected = false;
    };

    BrickMasks filled() const { return {around_, filledMasks_.data()}; }

    /// Whether cells of a box end rays now.
    bool isCut(const CellBox& box) const { return anyInside(box, filled(), *filledCounts_); }

    /// Whether a box beside a brick that has become empty can be larger.
    bool mayGrow(const CellBox& box) const {
        if ((*emptiedCounts_)(bricksOf(box.grown(1))) == 0) return false;
        for (int side = 0; side < 6; ++side) {
            const CellBox cells =
                cellsBeside(box, side, 1).clippedTo({Array3i::Zero(), grid_.size});
            if (!cells.empty() && isFree(cells)) return true;
        }
        return false;
    }

    /// Mostly one of the first bricks decides: counting them all would take longer.
    bool isFree(const CellBox& cells) const {
        const CellBox bricks = bricksOf(cells);
        for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
            for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
                const std::uint64_t* ends = &grid_.ends[grid_.brickIndex({bricks.low.x(), y, z})];
                for (int x = bricks.low.x(); x < bricks.high.x(); ++x, ++ends) {
                    if (*ends != 0 && (*ends & cellsInside(cells, {x, y, z})) != 0) return false;
                }
            }
        }
        return true;
    }

    const VoxelGrid& grid_;
    CellBox around_;
    std::vector<std::uint64_t> filledMasks_;  // cells that have begun to end rays
    std::optional<BrickCounts> filledCounts_, emptiedCounts_;
    std::array<Answer, kAnswers> answers_;
};

bool isNone(const EmptyBox& box) { return box.after[0] == 0; }

/// Whether a brick and the next one along x store the same box.
bool isShared(const EmptyBox& here, const EmptyBox& next) {
    return next.before[0] == here.before[0] + 4 && next.after[0] + 4 == here.after[0] &&
           next.before[1] == here.before[1] && next.after[1] == here.after[1] &&
           next.before[2] == here.before[2] && next.after[2] == here.after[2];
}

/// Calls visit(brick, isRepeated) for every brick of some bricks that has a box, x fastest.
/// isRepeated: it is the box of the brick visited before. `visit` may change the brick's box.
template <class Visit>
void visitBoxes(const VoxelGrid& grid, const CellBox& bricks, const Visit& visit) {
    for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
        for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
            const EmptyBox* stored = &grid.boxes[grid.brickIndex({bricks.low.x(), y, z})];
            EmptyBox last;
            for (int x = bricks.low.x(); x < bricks.high.x(); ++x, ++stored) {
                const EmptyBox box = *stored;
                if (!isNone(box)) visit(Array3i(x, y, z), isShared(last, box));
                last = box;
            }
        }
    }
}

}  // namespace

std::uint64_t cellsInside(const CellBox& box, const Array3i& brick) {
    const CellBox cells = cellsOf(brick);
    if (box.contains(cells)) return ~0ULL;
    const CellBox part = box.clippedTo(cells);
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
    bool isLastAffected = false;
    const auto forget = [&](const Array3i& brick) {
        toFind.push_back(brick);
        rewritten.extend({brick, brick + 1});
        grid.boxes[grid.brickIndex(brick)] = {};
    };
    for (const ChangedBrick& change : changed) forget(change.brick);
    const CellBox near = isAffected.around()
                             .grown(EmptyBox::kFurthest / 4)
                             .clippedTo({Array3i::Zero(), Array3i(grid.bricks)});
    visitBoxes(grid, near, [&](const Array3i& brick, bool isRepeated) {
        if (!isRepeated) isLastAffected = isAffected(emptyBoxOf(grid, brick));
        if (isLastAffected) forget(brick);
    });
    BoxFinder finder(grid, rewritten);
    for (const Array3i& brick : toFind) finder.find(brick);
    return rewritten;
}

}  // namespace photonav
