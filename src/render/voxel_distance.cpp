// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "render/voxel_grid.hpp"

namespace photonav {
namespace {

constexpr std::uint8_t kFar = VoxelGrid::kMaxDistance;

/// Chessboard distance: one pass forward and one backward over the rows, each taking the least
/// distance of the 26 neighbours that lie in rows already done.
class DistancePasses {
  public:
    DistancePasses(VoxelGrid& grid, const CellBox& box)
        : grid_(grid),
          box_(box),
          reach_(grid.reach()),
          from_(std::max(box.low.x() - 1, reach_.low.x())),
          to_(std::min(box.high.x() + 1, reach_.high.x())),
          length_(box.high.x() - box.low.x()),
          best_(std::size_t(length_) + 2, kFar),
          row_(std::size_t(length_) + 2 * kFar, kFar),
          next_(row_) {}

    void forgetDistances() {
        for (int z = box_.low.z(); z < box_.high.z(); ++z) {
            for (int y = box_.low.y(); y < box_.high.y(); ++y) {
                std::uint8_t* cells = row(y, z);
                for (int x = box_.low.x(); x < box_.high.x(); ++x) {
                    cells[x] = cells[x] == 0 ? std::uint8_t{0} : kFar;
                }
            }
        }
    }

    void runForward() {
        for (int z = box_.low.z(); z < box_.high.z(); ++z) {
            for (int y = box_.low.y(); y < box_.high.y(); ++y) {
                relax(y, z, -1);
                spread(row(y, z), box_.low.x() - 1, 1);
            }
        }
    }

    void runBackward() {
        for (int z = box_.high.z() - 1; z >= box_.low.z(); --z) {
            for (int y = box_.high.y() - 1; y >= box_.low.y(); --y) {
                relax(y, z, 1);
                spread(row(y, z), box_.high.x(), -1);
            }
        }
    }

  private:
    std::uint8_t* row(int y, int z) { return grid_.distance.data() + grid_.cellIndex(0, y, z); }

    /// Along a row, a cell is at most one farther than the one before it. Steps of 1, 2, 4 ...
    /// cells in place of one after the other, since the processor takes 32 cells at a time.
    /// @param before the column before the row's first cell in the given direction
    void spread(std::uint8_t* cells, int before, int direction) {
        const std::size_t border = direction > 0 ? kFar - 1 : kFar + length_;
        const bool counts = before >= from_ && before < to_;
        row_[border] = next_[border] = counts ? cells[before] : kFar;
        std::copy_n(cells + box_.low.x(), length_, row_.data() + kFar);
        for (int step = 1; step < kFar; step *= 2) {
            const std::uint8_t* here = row_.data() + kFar;
            const std::uint8_t* behind = here - direction * step;
            std::uint8_t* out = next_.data() + kFar;
            for (int i = 0; i < length_; ++i) {
                out[i] = std::min(here[i], static_cast<std::uint8_t>(behind[i] + step));
            }
            row_.swap(next_);
        }
        row_[border] = next_[border] = kFar;
        std::copy_n(row_.data() + kFar, length_, cells + box_.low.x());
    }

    void take(int y, int z) {
        if (y < reach_.low.y() || y >= reach_.high.y()) return;
        if (z < reach_.low.z() || z >= reach_.high.z()) return;
        const std::uint8_t* from = row(y, z) + from_;
        std::uint8_t* best = best_.data() + (from_ - (box_.low.x() - 1));
        for (int i = 0; i < to_ - from_; ++i) best[i] = std::min(best[i], from[i]);
    }

    void relax(int y, int z, int back) {
        std::fill(best_.begin(), best_.end(), kFar);
        take(y + back, z);
        for (int dy = -1; dy <= 1; ++dy) take(y + dy, z + back);
        std::uint8_t* cells = row(y, z) + box_.low.x();
        const std::uint8_t* best = best_.data();
        for (int i = 0; i < length_; ++i) {
            const std::uint8_t near = std::min(std::min(best[i], best[i + 2]), best[i + 1]);
            cells[i] = std::min(cells[i], static_cast<std::uint8_t>(near + 1));
        }
    }

    VoxelGrid& grid_;
    CellBox box_, reach_;
    int from_, to_;                   // columns that count: those of the box and one to each side
    int length_;                      // of the box's rows
    std::vector<std::uint8_t> best_;  // of the rows around, from the column before the box on
    std::vector<std::uint8_t> row_, next_;  // a row of the box, with a border of kFar cells
};

}  // namespace

void measureDistances(VoxelGrid& grid, const CellBox& within) {
    const CellBox box = within.clippedTo(grid.reach());
    if (box.empty()) return;
    DistancePasses passes(grid, box);
    passes.forgetDistances();
    passes.runForward();
    passes.runBackward();
}

}  // namespace photonav
