// SPDX-License-Identifier: BSD-3-Clause
// What an observation changed in a map, for everything that is computed from the map.
#pragma once

#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// The parts of a map that changed. Everything computed from the map (clearance, views,
/// information, plans) can be updated from it at a cost that grows with the size of the change, not
/// of the map.
///
/// Space is divided into bricks of 4 x 4 x 4 cells. A brick is named by its index along each axis,
/// the world index of its cells divided by 4 and rounded down; brick 0 begins at the origin. All
/// lists are sorted by z, then y, then x, without repetition.
struct MapChange {
    static constexpr int kBrickEdge = 4;  ///< [cells]

    double resolution = 0.;  ///< edge of a cell [m]; 0 while nothing changed

    /// Bricks in which a cell became known, free or occupied.
    std::vector<Eigen::Array3i> occupancy{};
    /// Bricks in which the grey value of an occupied cell's face changed by more than
    /// FusionOptions::greyTolerance, or a surface in it by more than surfaceTolerance, since the
    /// brick was last listed here. All other changes of what views show are smaller.
    std::vector<Eigen::Array3i> texture{};
    /// Bricks in which the grey value of an occupied cell's face, or a surface in it, changed at
    /// all, as exactly as a VoxelRenderer shows them. Contains all bricks of `texture`, if the
    /// change comes from fuse().
    std::vector<Eigen::Array3i> anyTexture{};

    bool empty() const { return occupancy.empty() && texture.empty() && anyTexture.empty(); }

    /// Adds what another change lists, so that this one describes both.
    /// @throws std::invalid_argument when the changes are of maps of different resolutions
    void join(const MapChange& other);

    /// Sorts the lists and removes repetitions, for changes that are put together by hand.
    void normalize();

    /// The union of the three lists.
    std::vector<Eigen::Array3i> bricks() const;

    Eigen::AlignedBox3d box() const;           ///< of bricks(), world frame [m]
    Eigen::AlignedBox3d occupancyBox() const;  ///< of `occupancy`, world frame [m]
    Eigen::AlignedBox3d boxOf(const Eigen::Array3i& brick) const;  ///< world frame [m]
};

}  // namespace photonav
