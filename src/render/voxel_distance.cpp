// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "render/voxel_grid.hpp"

namespace photonav {
namespace {

constexpr std::uint8_t kFar = VoxelGrid::kMostDistance;

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
          best_(std::size_t(box.high.x() - box.low.x()) + 2, kFar) {}

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
                std::uint8_t* cells = row(y, z);
                unsigned run = from_ < box_.low.x() ? cells[from_] : kFar;
                for (int x = box_.low.x(); x < box_.high.x(); ++x) chain(cells[x], run);
            }
        }
    }

    void runBackward() {
        for (int z = box_.high.z() - 1; z >= box_.low.z(); --z) {
            for (int y = box_.high.y() - 1; y >= box_.low.y(); --y) {
                relax(y, z, 1);
                std::uint8_t* cells = row(y, z);
                unsigned run = to_ > box_.high.x() ? cells[to_ - 1] : kFar;
                for (int x = box_.high.x() - 1; x >= box_.low.x(); --x) chain(cells[x], run);
            }
        }
    }

  private:
    std::uint8_t* row(int y, int z) { return grid_.distance.data() + grid_.cellIndex(0, y, z); }

    static void chain(std::uint8_t& cell, unsigned& run) {
        run = std::min<unsigned>(cell, run + 1);
        cell = static_cast<std::uint8_t>(run);
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
        for (int i = 0; i < box_.high.x() - box_.low.x(); ++i) {
            const std::uint8_t near = std::min(std::min(best[i], best[i + 2]), best[i + 1]);
            cells[i] = std::min(cells[i], static_cast<std::uint8_t>(near + 1));
        }
    }

    VoxelGrid& grid_;
    CellBox box_, reach_;
    int from_, to_;                   // columns that count: those of the box and one to each side
    std::vector<std::uint8_t> best_;  // of the rows around, from the column before the box on
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
