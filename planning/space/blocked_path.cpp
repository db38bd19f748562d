// SPDX-License-Identifier: BSD-3-Clause
#include "space/blocked_path.hpp"

#include <algorithm>
#include <numbers>

#include "geometry/segment.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

double distanceToPath(const Vector3d& p, const std::vector<Vector3d>& waypoints) {
    double least = (p - waypoints.front()).norm();
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
        least = std::min(least, distanceToSegment(p, waypoints[i - 1], waypoints[i]));
    }
    return least;
}

}  // namespace

bool blocksPath(const TexturedOcTree& map, const MapChange& change,
                const std::vector<Vector3d>& waypoints, double radius) {
    if (waypoints.empty()) return false;
    constexpr int kEdge = MapChange::kBrickEdge;
    const double aroundCell = 0.5 * std::numbers::sqrt3 * change.resolution;
    for (const Eigen::Array3i& brick : change.occupancy) {
        const Vector3d centre = change.boxOf(brick).center();
        if (distanceToPath(centre, waypoints) > radius + kEdge * aroundCell) continue;
        const Vector3d low = change.boxOf(brick).min();
        for (int i = 0; i < kEdge * kEdge * kEdge; ++i) {
            const Eigen::Array3i cell(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge));
            const Vector3d p = low + change.resolution * (cell.cast<double>() + 0.5).matrix();
            const auto* node = map.search(p.x(), p.y(), p.z());
            if (node == nullptr || !map.isNodeOccupied(node)) continue;
            if (distanceToPath(p, waypoints) < radius + aroundCell) return true;
        }
    }
    return false;
}

}  // namespace photonav
