// SPDX-License-Identifier: BSD-3-Clause
// The occupied cells of a map that grows, as what changed since the last time.
#pragma once

#include <map>
#include <set>

#include "flightlog/flight_log.hpp"
#include "map/map_change.hpp"

namespace photonav {

/// Cells of the map, or cubes of 2^level of them a side: so many that what can be seen from within
/// the bounds takes at most about a hundred thousand.
class DrawnCells {
  public:
    /// @param bounds of the flight [m]; @param resolution of the map [m]
    DrawnCells(const Eigen::AlignedBox3d& bounds, double resolution);

    double size() const { return size_; }  ///< of a drawn cell [m]

    /// What is drawn otherwise since the last call. Changes of the grey level below a fortieth are
    /// left out until they add up to more.
    /// @param change all that changed in the map since then
    CellChanges update(const TexturedOcTree& map, const MapChange& change);

  private:
    using Index = std::array<int, 3>;

    std::set<Index> touched(const MapChange& change) const;
    std::uint8_t greyOf(const TexturedOcTree& map, const Index& cube) const;

    int level_ = 0;
    double size_;
    std::map<Index, std::uint8_t> drawn_;
};

}  // namespace photonav
