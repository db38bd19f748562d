// SPDX-License-Identifier: BSD-3-Clause
// Where a change of the map may have changed clearance.
#pragma once

#include "map/map_change.hpp"

namespace photonav {

/// The box around the cells whose occupancy changed, grown by as far as clearance is computed.
class ChangedSpace {
  public:
    /// @param clearanceCap DistanceMap::maxDistance(): obstacles farther away change nothing [m]
    ChangedSpace(const MapChange& change, double clearanceCap);

    bool contains(const Eigen::Vector3d& p_w) const { return box_.contains(p_w); }

    /// Whether a straight motion passes through.
    bool touches(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const;

  private:
    Eigen::AlignedBox3d box_;  // empty where no occupancy changed
};

}  // namespace photonav
