// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/drawn_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "map/brick_leaves.hpp"

namespace photonav {
namespace {

constexpr double kMostCells = 2e5;  // on the six sides of the bounds
constexpr int kGreyTolerance = 6;   // of 255
constexpr std::uint8_t kWhitest = 254;
constexpr std::uint8_t kNeverSeen = 127;

double surfaceOf(const Eigen::AlignedBox3d& box) {
    const Eigen::Vector3d s = box.sizes();
    return 2. * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
}

}  // namespace

DrawnCells::DrawnCells(const Eigen::AlignedBox3d& bounds, double resolution) : size_(resolution) {
    for (; surfaceOf(bounds) / (size_ * size_) > kMostCells; size_ *= 2.) ++level_;
}

/// The cubes in which bricks of the change lie.
std::set<DrawnCells::Index> DrawnCells::touched(const MapChange& change) const {
    std::set<Index> cubes;
    const int perBrick = std::max(1, MapChange::kBrickEdge >> level_);
    for (const Eigen::Array3i& brick : change.bricks()) {
        const Index corner{MapChange::kBrickEdge * brick.x() >> level_,
                           MapChange::kBrickEdge * brick.y() >> level_,
                           MapChange::kBrickEdge * brick.z() >> level_};
        for (int i = 0; i < perBrick * perBrick * perBrick; ++i) {
            cubes.insert({corner[0] + i % perBrick, corner[1] + i / perBrick % perBrick,
                          corner[2] + i / (perBrick * perBrick)});
        }
    }
    return cubes;
}

/// Mean grey level of the occupied cells in a cube; kGone where there are none.
std::uint8_t DrawnCells::greyOf(const TexturedOcTree& map, const Index& cube) const {
    const int side = 1 << level_;
    const Eigen::Array3i first(cube[0] * side, cube[1] * side, cube[2] * side);
    const auto brickOf = [](const Eigen::Array3i& cell) {
        return Eigen::Array3i(cell.unaryExpr([](int i) { return i >> 2; }));
    };
    static_assert(MapChange::kBrickEdge == 4);
    const Eigen::Array3i lowest = brickOf(first), highest = brickOf(first + side - 1);
    double sum = 0., count = 0.;
    for (int z = lowest.z(); z <= highest.z(); ++z) {
        for (int y = lowest.y(); y <= highest.y(); ++y) {
            for (int x = lowest.x(); x <= highest.x(); ++x) {
                const Eigen::Array3i brick(x, y, z);
                const TexturedOcTreeNode* node = findBrick(map, brick);
                if (node == nullptr) continue;
                const Eigen::Array3i inBrick = first - MapChange::kBrickEdge * brick;
                visitLeaves(
                    map, *node,
                    [&](const TexturedOcTreeNode& leaf, const Eigen::Array3i& corner, int edge) {
                        if (!map.isNodeOccupied(leaf)) return;
                        const Eigen::Array3i common =
                            (corner + edge).min(inBrick + side) - corner.max(inBrick);
                        if ((common <= 0).any()) return;
                        const auto grey = leaf.meanGrey();
                        count += common.prod();
                        sum += common.prod() * (grey ? greyLevel(*grey) : kNeverSeen);
                    });
            }
        }
    }
    if (count == 0.) return CellChanges::kGone;
    return std::min(kWhitest, static_cast<std::uint8_t>(std::lround(sum / count)));
}

CellChanges DrawnCells::update(const TexturedOcTree& map, const MapChange& change) {
    CellChanges changes;
    for (const Index& cube : touched(change)) {
        const std::uint8_t grey = greyOf(map, cube);
        const auto old = drawn_.find(cube);
        const bool wasDrawn = old != drawn_.end();
        if (grey == CellChanges::kGone) {
            if (!wasDrawn) continue;
            drawn_.erase(old);
        } else {
            if (wasDrawn && std::abs(grey - old->second) <= kGreyTolerance) continue;
            drawn_[cube] = grey;
        }
        for (const int i : cube) changes.indices.push_back(static_cast<std::int16_t>(i));
        changes.greys.push_back(grey);
    }
    return changes;
}

}  // namespace photonav
