// SPDX-License-Identifier: BSD-3-Clause
// The part of space where a change of the map may have freed motions or put them in collision.
#pragma once

#include "map/brick_tree.hpp"

namespace photonav {

/// The bricks whose occupancy changed, grown by the distance within which obstacles affect a
/// motion.
class ChangedSpace {
  public:
    /// @param obstacleReach distance beyond which obstacles do not affect a motion [m]
    ChangedSpace(const MapChange& change, double obstacleReach);

    /// Whether a point is in the changed space (world frame [m]).
    bool contains(const Eigen::Vector3d& p_w) const;

    /// Whether the straight motion between two points (world frame [m]) intersects it.
    bool touches(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const;

  private:
    BrickTree bricks_;
};

}  // namespace photonav
