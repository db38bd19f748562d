// SPDX-License-Identifier: BSD-3-Clause
// Which empty boxes of a grid a change affects.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "render/brick_counts.hpp"
#include "render/voxel_boxes.hpp"

namespace photonav {

/// The cells beside a box on one side: 0 is low x, 1 is high x, 2 is low y, ...
CellBox cellsBeside(const CellBox& box, int side, int thickness);

/// A hash of a box.
unsigned hashOf(const CellBox& box);

/// The rest of a box, in at most one part per side.
class BoxParts {
  public:
    void add(const CellBox& part) { parts_[count_++] = part; }
    const CellBox* begin() const { return parts_.data(); }
    const CellBox* end() const { return begin() + count_; }

  private:
    std::array<CellBox, 6> parts_;
    std::size_t count_ = 0;
};

/// Which empty boxes a change of the grid affects, and what is left of them.
class AffectedBoxes {
  public:
    /// @param changed bricks whose VoxelGrid::ends has changed, each at most once
    AffectedBoxes(const VoxelGrid& grid, const std::vector<ChangedBrick>& changed);

    /// The changed bricks are in this box of bricks.
    const CellBox& around() const { return around_; }

    /// Whether cells of a box end rays now, or a brick beside it has become empty so that it can be
    /// larger.
    bool operator()(const CellBox& box);

    /// Whether cells of a box end rays now.
    bool isCut(const CellBox& box) const { return anyInside(box, filled(), *filledCounts_); }

    /// What is left of a box on each side of its cells that end rays now. Together these parts hold
    /// all of the box but the space between such cells.
    BoxParts cut(const CellBox& box) const;

  private:
    static constexpr unsigned kAnswers = 256;
    struct Answer {
        CellBox box;
        bool isAffected = false;
    };

    BrickMasks filled() const { return {around_, filledMasks_.data()}; }
    CellBox filledCellsIn(const CellBox& box) const;
    bool mayGrow(const CellBox& box);
    bool isFree(const CellBox& cells);
    const BrickCounts& endCounts();

    const VoxelGrid& grid_;
    CellBox around_;
    std::vector<std::uint64_t> filledMasks_;  // cells that have begun to end rays
    CellBox filledCells_;                     // their bounding box
    std::optional<BrickCounts> filledCounts_, emptiedCounts_;
    std::optional<BrickCounts> endCounts_;  // made when it is needed
    std::array<Answer, kAnswers> answers_;
};

}  // namespace photonav
