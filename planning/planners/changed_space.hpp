// SPDX-License-Identifier: BSD-3-Clause
// The part of space where a change of the map may have freed motions or put them in collision.
#pragma once

#include "map/map_change.hpp"

namespace photonav {

/// The bounding box of the bricks whose occupancy changed, grown by the distance within which
/// obstacles affect a motion.
class ChangedSpace {
  public:
    /// @param obstacleReach distance beyond which obstacles do not affect a motion [m]
    ChangedSpace(const MapChange& change, double obstacleReach);

    /// Whether the box contains a point (world frame [m]).
    bool contains(const Eigen::Vector3d& p_w) const { return box_.contains(p_w); }

    /// Whether the straight motion between two points (world frame [m]) intersects the box.
    bool touches(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const;

  private:
    Eigen::AlignedBox3d box_;  // empty where no occupancy changed
};

}  // namespace photonav
