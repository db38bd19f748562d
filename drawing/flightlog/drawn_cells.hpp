// SPDX-License-Identifier: BSD-3-Clause
// The occupied cells of a growing map, as changes from update to update.
#pragma once

#include <map>
#include <set>

#include "flightlog/flight_log.hpp"
#include "map/map_change.hpp"

namespace photonav {

/// Drawn cells are cells of the map, or cubes of 2^level cells per side. The level is chosen so
/// that about 100 000 drawn cells cover the six sides of the bounds.
class DrawnCells {
  public:
    /// @param bounds of the flight, world frame [m]
    /// @param resolution edge of the map's cells [m]
    DrawnCells(const Eigen::AlignedBox3d& bounds, double resolution);

    double size() const { return size_; }  ///< edge of a drawn cell [m]

    /// The drawn cells that changed since the last call. A change of the grey level by less than
    /// about 1/40 is left out until it adds up to more.
    /// @param change everything that changed in the map since the last call
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
