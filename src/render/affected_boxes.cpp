// SPDX-License-Identifier: BSD-3-Clause
#include "render/affected_boxes.hpp"

#include <bit>

namespace photonav {
using Eigen::Array3i;

unsigned hashOf(const CellBox& box) {
    const Array3i mixed = box.low * Array3i(1, 9, 81) + box.high * Array3i(27, 243, 729);
    return static_cast<unsigned>(mixed.sum());
}

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

AffectedBoxes::AffectedBoxes(const VoxelGrid& grid, const std::vector<ChangedBrick>& changed)
    : grid_(grid) {
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
        filledCells_.extend(boundsOf(filledMasks_[at], change.brick));
    }
    filledCounts_.emplace(filled(), around_);
    emptiedCounts_.emplace(BrickMasks{around_, emptied.data()}, around_);
}

/// Many bricks share a box: answers are kept.
bool AffectedBoxes::operator()(const CellBox& box) {
    if (bricksOf(box.grown(1)).clippedTo(around_).empty()) return false;
    Answer& answer = answers_[hashOf(box) % kAnswers];
    if (answer.box != box) answer = {box, isCut(box) || mayGrow(box)};
    return answer.isAffected;
}

BoxParts AffectedBoxes::cut(const CellBox& box) const {
    const CellBox filled = filledCellsIn(box);
    BoxParts parts;
    for (int axis = 0; axis < 3; ++axis) {
        CellBox low = box, high = box;
        low.high[axis] = filled.low[axis];
        high.low[axis] = filled.high[axis];
        if (!low.empty()) parts.add(low);
        if (!high.empty()) parts.add(high);
    }
    return parts;
}

/// The bounding box of the cells in a box that end rays now.
CellBox AffectedBoxes::filledCellsIn(const CellBox& box) const {
    if (box.contains(filledCells_)) return filledCells_;
    CellBox bricks = bricksOf(box.clippedTo(filledCells_));
    for (int axis = 0; axis < 3; ++axis) {
        const auto isEmptyUpTo = [&](int low, int high) {
            CellBox part = bricks;
            part.low[axis] = low;
            part.high[axis] = high;
            return (*filledCounts_)(part) == 0;
        };
        const int low = bricks.low[axis], high = bricks.high[axis];
        int first = low, last = high;
        const auto most = std::bit_floor(static_cast<unsigned>(high - low));
        for (int step = static_cast<int>(most); step > 0; step /= 2) {
            if (first + step <= high && isEmptyUpTo(low, first + step)) first += step;
            if (last - step >= low && isEmptyUpTo(last - step, high)) last -= step;
        }
        bricks.low[axis] = first;
        bricks.high[axis] = last;
    }
    return CellBox{4 * bricks.low, 4 * bricks.high}.clippedTo(box).clippedTo(filledCells_);
}

/// Whether a box beside a brick that has become empty can be larger.
bool AffectedBoxes::mayGrow(const CellBox& box) {
    for (int side = 0; side < 6; ++side) {
        const CellBox cells = cellsBeside(box, side, 1).clippedTo({Array3i::Zero(), grid_.size});
        if (!cells.empty() && (*emptiedCounts_)(bricksOf(cells)) > 0 && isFree(cells)) {
            return true;
        }
    }
    return false;
}

/// Mostly one of the first bricks decides: only where it does not, all of them are counted.
bool AffectedBoxes::isFree(const CellBox& cells) {
    constexpr int kFew = 256;
    const CellBox bricks = bricksOf(cells);
    int looked = 0;
    for (int z = bricks.low.z(); z < bricks.high.z(); ++z) {
        for (int y = bricks.low.y(); y < bricks.high.y(); ++y) {
            const std::uint64_t* ends = &grid_.ends[grid_.brickIndex({bricks.low.x(), y, z})];
            for (int x = bricks.low.x(); x < bricks.high.x(); ++x, ++ends) {
                if (*ends != 0 && (*ends & cellsInside(cells, {x, y, z})) != 0) return false;
            }
            looked += bricks.high.x() - bricks.low.x();
            if (looked > kFew) return !anyInside(cells, endMasks(grid_), endCounts());
        }
    }
    return true;
}

/// Of all bricks that boxes around the changed bricks reach.
const BrickCounts& AffectedBoxes::endCounts() {
    constexpr int kReach = EmptyBox::kFurthest / 4;
    if (!endCounts_) {
        const CellBox all{Array3i::Zero(), Array3i(grid_.bricks)};
        endCounts_.emplace(endMasks(grid_), around_.grown(2 * kReach + 1).clippedTo(all));
    }
    return *endCounts_;
}

}  // namespace photonav
