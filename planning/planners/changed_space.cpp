// SPDX-License-Identifier: BSD-3-Clause
#include "planners/changed_space.hpp"

#include <algorithm>

namespace photonav {
namespace {

/// Whether the straight motion between two points intersects a box.
bool intersects(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from,
                const Eigen::Vector3d& to) {
    const Eigen::Vector3d way = to - from;
    double enter = 0.;
    double leave = 1.;
    for (int i = 0; i < 3; ++i) {
        const double low = box.min()[i] - from[i];
        const double high = box.max()[i] - from[i];
        if (way[i] == 0.) {
            if (low > 0. || high < 0.) return false;
            continue;
        }
        enter = std::max(enter, std::min(low / way[i], high / way[i]));
        leave = std::min(leave, std::max(low / way[i], high / way[i]));
    }
    return enter <= leave;
}

}  // namespace

/// Clearance is interpolated between the centres of cells.
ChangedSpace::ChangedSpace(const MapChange& change, double obstacleReach)
    : bricks_(change, change.occupancy, obstacleReach + 2. * change.resolution) {}

bool ChangedSpace::contains(const Eigen::Vector3d& p_w) const {
    return bricks_.any([&](const Eigen::AlignedBox3d& box) { return box.contains(p_w); });
}

bool ChangedSpace::touches(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const {
    return bricks_.any(
        [&](const Eigen::AlignedBox3d& box) { return intersects(box, from_w, to_w); });
}

}  // namespace photonav
