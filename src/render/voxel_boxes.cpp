// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_boxes.hpp"

#include <algorithm>
#include <bit>

#include "render/affected_boxes.hpp"
#include "render/brick_counts.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;

/// A mask of the bits [from, to) of a row of four cells.
std::uint64_t fourBits(int from, int to) { return (1ULL << to) - (1ULL << from); }

std::uint64_t bitsBelow(int count) { return count < 64 ? (1ULL << count) - 1 : ~0ULL; }

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

double volume(const CellBox& box) {
    return box.empty() ? 0. : (box.high - box.low).cast<double>().prod();
}

class BoxFinder {
  public:
    /// @param around the bricks whose boxes are to be found lie in this box of bricks
    BoxFinder(VoxelGrid& grid, const CellBox& around)
        : grid_(grid),
          reached_(
              CellBox{4 * around.low - EmptyBox::kFurthest, 4 * around.high + EmptyBox::kFurthest}
                  .clippedTo({Array3i::Zero(), grid.size})),
          full_(endMasks(grid), bricksOf(reached_)) {}

    /// All cells that boxes can reach.
    const CellBox& reached() const { return reached_; }

    /// Finds the box of a brick. Neighbours have valid boxes, or of size 0.
    void find(const Array3i& brick) {
        const std::size_t index = grid_.brickIndex(brick);
        const CellBox layer = emptyLayer(grid_.ends[index], brick);
        CellBox box;
        if (!layer.empty()) box = largestAround(layer, brick);
        if (!box.empty()) {
            extendReach(box, brick);
        } else if (!layer.empty()) {
            box = grow(layer, limits(brick));
        }
        grid_.boxes[index] = encoded(box, brick, grid_.ends[index]);
    }

    /// Stores the largest of some empty boxes that holds a layer of a brick.
    /// @return false if none does
    bool choose(const BoxParts& boxes, const Array3i& brick) {
        const std::size_t index = grid_.brickIndex(brick);
        const CellBox layer = emptyLayer(grid_.ends[index], brick);
        if (layer.empty()) return false;
        const CellBox* largest = nullptr;
        for (const CellBox& box : boxes) {
            if (!box.contains(layer)) continue;
            if (largest == nullptr || volume(box) > volume(*largest)) largest = &box;
        }
        if (largest == nullptr) return false;
        grid_.boxes[index] = encoded(largest->clippedTo(limits(brick)), brick, grid_.ends[index]);
        return true;
    }

    /// Grows a box to all sides in turn, at first by whole bricks, more and more at a time. Where a
    /// step was too far, it is so for good, because the box only grows.
    CellBox grow(CellBox box, const CellBox& limit) const {
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

  private:
    /// The largest box of the neighbours that holds a layer of a brick, or an empty one. Most
    /// bricks share a box with their neighbours.
    CellBox largestAround(const CellBox& layer, const Array3i& brick) const {
        CellBox largest;
        const CellBox limit = limits(brick);
        for (int side = 0; side < 6; ++side) {
            Array3i neighbour = brick;
            neighbour[side / 2] += side % 2 == 0 ? -1 : 1;
            if ((neighbour < 0).any() || (neighbour >= grid_.bricks).any()) continue;
            const CellBox box = emptyBoxOf(grid_, neighbour).clippedTo(limit);
            if (!box.contains(layer)) continue;
            if (volume(box) > volume(largest)) largest = box;
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
            reached_);
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
    CellBox reached_;
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

/// The boxes that take the place of an affected one: its parts, or a larger one. Many bricks share
/// a box: answers are kept.
class Replacements {
  public:
    Replacements(const AffectedBoxes& affected, const BoxFinder& finder)
        : affected_(affected), finder_(finder) {}

    const BoxParts& of(const CellBox& box) {
        Answer& answer = answers_[hashOf(box) % kAnswers];
        if (answer.box != box) answer = {box, find(box)};
        return answer.parts;
    }

  private:
    static constexpr unsigned kAnswers = 64;
    struct Answer {
        CellBox box;
        BoxParts parts;
    };

    BoxParts find(const CellBox& box) {
        if (affected_.isCut(box)) return affected_.cut(box);
        BoxParts larger;
        larger.add(grown(box));
        return larger;
    }

    /// Boxes that differ by how far their bricks reach grow into the same one.
    CellBox grown(const CellBox& box) {
        if (!grown_.contains(box)) grown_ = finder_.grow(box, finder_.reached());
        return grown_;
    }

    const AffectedBoxes& affected_;
    const BoxFinder& finder_;
    std::array<Answer, kAnswers> answers_;
    CellBox grown_;  // the last one
};

/// Bricks along x, the empty boxes of which differ in x only and make up one empty box.
struct BoxRun {
    Array3i first = Array3i::Zero();
    int bricks = 0;
    CellBox box;

    /// Adds the next brick unless its box differs otherwise.
    bool add(const CellBox& next) {
        const bool isSimilar = (next.low.tail<2>() == box.low.tail<2>()).all() &&
                               (next.high.tail<2>() == box.high.tail<2>()).all() &&
                               next.low.x() <= box.high.x() && next.high.x() >= box.low.x();
        if (!isSimilar) return false;
        box.extend(next);
        ++bricks;
        return true;
    }
};

/// Calls visit(run) for all bricks of some bricks that have a box. `visit` may change their boxes.
template <class Visit>
void visitRuns(const VoxelGrid& grid, const CellBox& bricks, const Visit& visit) {
    for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
        for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
            BoxRun run;
            for (int x = bricks.low.x(); x < bricks.high.x(); ++x) {
                const CellBox box = emptyBoxOf(grid, {x, y, z});
                const bool isNone = box.high.x() == 4 * x;
                if (run.bricks > 0 && !isNone && run.add(box)) continue;
                if (run.bricks > 0) visit(run);
                run = isNone ? BoxRun{} : BoxRun{{x, y, z}, 1, box};
            }
            if (run.bricks > 0) visit(run);
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

CellBox boundsOf(std::uint64_t cells, const Array3i& brick) {
    CellBox bounds;
    for (; cells != 0; cells &= cells - 1) {
        const int bit = std::countr_zero(cells);
        const Array3i cell = 4 * brick + Array3i(bit & 3, bit >> 2 & 3, bit >> 4);
        bounds.extend({cell, cell + 1});
    }
    return bounds;
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
    CellBox rewritten;
    for (const ChangedBrick& change : changed) {
        grid.boxes[grid.brickIndex(change.brick)] = {};
        rewritten.extend({change.brick, change.brick + 1});
    }
    AffectedBoxes isAffected(grid, changed);
    std::vector<BoxRun> outdated;
    const CellBox near = isAffected.around()
                             .grown(EmptyBox::kFurthest / 4)
                             .clippedTo({Array3i::Zero(), Array3i(grid.bricks)});
    visitRuns(grid, near, [&](const BoxRun& run) {
        if (!isAffected(run.box)) return;
        std::fill_n(&grid.boxes[grid.brickIndex(run.first)], run.bricks, EmptyBox{});
        rewritten.extend({run.first, run.first + Array3i(run.bricks, 1, 1)});
        outdated.push_back(run);
    });
    BoxFinder finder(grid, rewritten);
    for (const ChangedBrick& change : changed) finder.find(change.brick);
    Replacements replacements(isAffected, finder);
    for (const BoxRun& run : outdated) {
        const BoxParts parts = replacements.of(run.box);
        for (int i = 0; i < run.bricks; ++i) {
            const Array3i brick = run.first + Array3i(i, 0, 0);
            if (!finder.choose(parts, brick)) finder.find(brick);
        }
    }
    return rewritten;
}

}  // namespace photonav
