// SPDX-License-Identifier: BSD-3-Clause
// Where a change of the map may have made motions free or put them in collision.
#pragma once

#include "map/map_change.hpp"

namespace photonav {

/// The box around the cells whose occupancy changed, grown by the distance at which obstacles
/// matter.
class ChangedSpace {
  public:
    /// @param obstacleReach obstacles farther away do not matter [m]
    ChangedSpace(const MapChange& change, double obstacleReach);

    bool contains(const Eigen::Vector3d& p_w) const { return box_.contains(p_w); }

    /// Whether a straight motion passes through.
    bool touches(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const;

  private:
    Eigen::AlignedBox3d box_;  // empty where no occupancy changed
};

}  // namespace photonav
