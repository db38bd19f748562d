// SPDX-License-Identifier: BSD-3-Clause
// The parts of a map that an observation has changed, for updates of everything that is computed
// from the map.
#pragma once

#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// The parts of a map that changed. Everything that is computed from the map (clearance, views,
/// information, plans) can be updated by a MapChange, at a cost that grows with the size of the
/// change, not of the map.
///
/// Space is divided into bricks of 4 x 4 x 4 cells. A brick is identified by its index along each
/// axis: the world index of its cells divided by 4 and rounded down; brick 0 begins at the origin.
/// All lists are sorted by z, then y, then x, without repetition.
struct MapChange {
    static constexpr int kBrickEdge = 4;  ///< edge of a brick [cells]

    double resolution = 0.;  ///< edge of a cell [m]; 0 while nothing changed

    /// Bricks in which the state of a cell (unknown, free or occupied) changed.
    std::vector<Eigen::Array3i> occupancy{};
    /// Bricks with occupied cells in which the grey value of a face may have changed by more than
    /// FusionOptions::greyTolerance, or a surface by more than FusionOptions::surfaceTolerance,
    /// since the brick was last listed here; or in which the weight of a grey value doubled, by
    /// which views merge it with those of neighbouring layers.
    std::vector<Eigen::Array3i> texture{};
    /// Bricks with occupied cells in which the grey value of a face, or a surface, changed at all
    /// at the resolution of a VoxelRenderer. Contains all bricks of `texture` if the change comes
    /// from fuse().
    std::vector<Eigen::Array3i> anyTexture{};

    bool empty() const { return occupancy.empty() && texture.empty() && anyTexture.empty(); }

    /// Adds the bricks of another change to this one.
    /// @throws std::invalid_argument when the changes are of maps of different resolutions
    void join(const MapChange& other);

    /// Sorts the lists and removes repetitions, for lists that were filled in any order.
    void normalize();

    /// The union of the three lists.
    std::vector<Eigen::Array3i> bricks() const;

    Eigen::AlignedBox3d box() const;  ///< bounding box of bricks(), world frame [m]
    Eigen::AlignedBox3d boxOf(const Eigen::Array3i& brick) const;  ///< world frame [m]
};

}  // namespace photonav
