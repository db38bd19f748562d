// SPDX-License-Identifier: BSD-3-Clause
#include "planners/changed_space.hpp"

#include <algorithm>

namespace photonav {

ChangedSpace::ChangedSpace(const MapChange& change, double obstacleReach) {
    if (change.occupancy.empty()) return;
    box_ = change.occupancyBox();
    // Clearance is interpolated between the centres of cells.
    const double margin = obstacleReach + 2. * change.resolution;
    box_.min().array() -= margin;
    box_.max().array() += margin;
}

bool ChangedSpace::touches(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const {
    if (box_.isEmpty()) return false;
    const Eigen::Vector3d way = to_w - from_w;
    double enter = 0.;
    double leave = 1.;
    for (int i = 0; i < 3; ++i) {
        const double low = box_.min()[i] - from_w[i];
        const double high = box_.max()[i] - from_w[i];
        if (way[i] == 0.) {
            if (low > 0. || high < 0.) return false;
            continue;
        }
        enter = std::max(enter, std::min(low / way[i], high / way[i]));
        leave = std::min(leave, std::max(low / way[i], high / way[i]));
    }
    return enter <= leave;
}

}  // namespace photonav
