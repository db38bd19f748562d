// SPDX-License-Identifier: BSD-3-Clause
// Clearance: how far a point is from the nearest obstacle.
#pragma once

#include "scene.hpp"
#include "textured_octree.hpp"

namespace photonav {

/// Capped exact Euclidean distance on a regular grid over a box.
class DistanceMap {
  public:
    struct Options {
        double maxDistance = 1.0;  ///< clearances beyond this read as this [m]
        UnknownPolicy unknown = UnknownPolicy::occupied;
    };

    /// No obstacles anywhere: every clearance is maxDistance.
    explicit DistanceMap(double maxDistance = 1.0) : maxDistance_(maxDistance) {}

    /// Obstacles are the occupied (and, by policy, the unknown) cells of the map.
    /// @param bounds where clearance will be asked for [m]; obstacles up to maxDistance outside
    ///        it count
    DistanceMap(const class TexturedOcTree& map, const Eigen::AlignedBox3d& bounds,
                const Options& options);

    /// Obstacles are the triangles, sampled into cells of `resolution` [m].
    DistanceMap(const Scene& scene, double resolution, const Eigen::AlignedBox3d& bounds,
                const Options& options);

    /// Distance from p_w to the nearest obstacle cell [m], capped at maxDistance; interpolated
    /// between cell centres, less half a cell. Outside the bounds: the value at the nearest cell.
    double clearance(const Eigen::Vector3d& p_w) const;

    double maxDistance() const { return maxDistance_; }

  private:
    double maxDistance_;
};

}  // namespace photonav
