// SPDX-License-Identifier: BSD-3-Clause
// Clearance: the distance from a point to the nearest obstacle.
#pragma once

#include <vector>

#include "map/distance_transform.hpp"
#include "map/map_change.hpp"
#include "map/textured_octree.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// Exact Euclidean distance to obstacles, up to a limit, on a regular grid over a box.
class DistanceMap {
  public:
    struct Options {
        /// Upper limit of the clearance [m]; at most 180 cells.
        double maxDistance = 1.0;
        UnknownPolicy unknown = UnknownPolicy::occupied;  ///< how unknown cells are treated
    };

    /// No obstacles anywhere: every clearance is maxDistance.
    explicit DistanceMap(double maxDistance = 1.0) : maxDistance_(maxDistance) {}

    /// Clearance in a map. Obstacles are the occupied cells and, by Options::unknown, the unknown
    /// ones.
    /// @param bounds box in which clearance is computed, world frame [m]; obstacles up to
    ///        maxDistance outside the box are included
    /// @throws std::invalid_argument for empty bounds, a maxDistance that is not positive or above
    ///        180 cells, or a grid above 3e9 bytes (the message names a resolution that would fit)
    DistanceMap(const TexturedOcTree& map, const Eigen::AlignedBox3d& bounds,
                const Options& options);

    /// Clearance in a scene. Obstacles are all cells that a triangle touches (and, along slanted
    /// outlines, some of their neighbours), and all cells whose centre is in a solid. Cells are
    /// cubes with an edge of `resolution` [m], centred at multiples of the resolution. Throws as
    /// above. Options::unknown has no effect, because a scene has no unknown space.
    DistanceMap(const Scene& scene, double resolution, const Eigen::AlignedBox3d& bounds,
                const Options& options);

    /// Distance from p_w to the nearest obstacle cell [m], at most maxDistance. Inside an obstacle
    /// it is negative, at least minus half a cell. At cell centres it is never too large and at
    /// most 0.37 cells too small, because only the distance between cell centres is stored, not the
    /// direction to the obstacle. Between cell centres it is interpolated: near edges and corners
    /// of obstacles it may be too large, by at most half a cell (at the corner of a single cell).
    /// Outside the bounds: the value at the nearest cell. Thread-safe.
    double clearance(const Eigen::Vector3d& p_w) const {
        if (grid_.empty()) return maxDistance_;
        const Eigen::Vector3d q = ((p_w - firstCentre_) * inverseResolution_)
                                      .cwiseMax(0.)
                                      .cwiseMin(lastCorner_ + Eigen::Vector3d::Ones());
        const Eigen::Vector3d corner = q.cwiseMin(lastCorner_);
        const Eigen::Array3i i = corner.array().cast<int>();
        const Eigen::Vector3f t = (q - i.cast<double>().matrix()).cast<float>();
        const float* c =
            grid_.data() + (std::size_t(i.z()) * size_.y() + i.y()) * size_.x() + i.x();
        const std::ptrdiff_t dy = size_.x();
        const std::ptrdiff_t dz = dy * size_.y();
        const auto alongX = [&](const float* d) { return d[0] + t.x() * (d[1] - d[0]); };
        const auto alongY = [&](const float* d) {
            const float near = alongX(d);
            return near + t.y() * (alongX(d + dy) - near);
        };
        const float near = alongY(c);
        return near + t.z() * (alongY(c + dz) - near);
    }

    double maxDistance() const { return maxDistance_; }

    /// Updates the clearances after a change of the map. The cost grows with the size of the
    /// change, and the result is bit-identical to a new DistanceMap of the map. Must not run while
    /// another thread calls clearance().
    /// @param change everything that changed in the map since this object was made or last updated
    /// @throws std::invalid_argument if this object was not made from a map, or from one of another
    ///        resolution
    void update(const TexturedOcTree& map, const MapChange& change);

  private:
    void begin(const struct ObstacleLayout& layout);
    bool compute();

    double maxDistance_;
    bool unknownIsObstacle_ = false;
    double resolution_ = 0.;
    double inverseResolution_ = 0.;
    Eigen::Vector3d firstCentre_ = Eigen::Vector3d::Zero();  ///< of the first cell [m]
    Eigen::Vector3d lastCorner_ = Eigen::Vector3d::Zero();   ///< last cell to interpolate from
    Eigen::Array3i size_ = Eigen::Array3i::Zero();           ///< cells
    Eigen::Array3i firstOuter_ = Eigen::Array3i::Zero();     ///< index of transform_'s first cell
    std::vector<float> grid_;  ///< clearance at cell centres [m], x fastest; empty: no obstacle
    std::vector<float> clearanceOf_;  ///< by squared distance in cells [m]
    DistanceTransform transform_;     ///< to update; empty: of a scene
};

}  // namespace photonav
