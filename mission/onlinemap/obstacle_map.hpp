// SPDX-License-Identifier: BSD-3-Clause
// The cells that count as occupied for collision checks in an incomplete map.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_set>

#include "config/explore_config.hpp"
#include "map/map_change.hpp"
#include "map/textured_octree.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// The number of cells that reach over a length [m], whatever their size [m].
inline int cellsOver(double length, double cell) {
    return static_cast<int>(std::ceil(length / cell - 1e-6));
}

/// Fewer cells are no wall, however large they are.
inline constexpr int kLeastWallCells = 4;

/// Least number of occupied cells above each other in a column that count as a wall: 20 cm, and
/// kLeastWallCells. Walls are continued upward.
inline int wallCells(double cell) { return std::max(kLeastWallCells, cellsOver(0.2, cell)); }

/// Errors of depth and pose that show a surface beside its place in the map [m].
inline constexpr double kSurfaceBeside = 0.05;

/// A camera that looks down observes the foot of a wall, but seldom the wall at the height at which
/// the robot flies. Walls are therefore continued upward: above the occupied cells of a wall in a
/// column, unknown cells count as occupied, up to the first ones that are known to be free, such as
/// those above the top of a box. Up to 5 cm of free cells (rounded up to whole cells) do not end a
/// wall: rays to places beside it clear a cell, where the view ends for example.
///
/// Other unknown cells are free (optimistic) or occupied (pessimistic), except at the body.
///
/// All functions that change obstacles return the bricks (blocks of cells) whose obstacles changed.
class ObstacleMap {
  public:
    /// @param resolution edge of the map's cells [m]
    /// @param bounds of the body's position, world frame [m]
    ObstacleMap(double resolution, const Eigen::AlignedBox3d& bounds, UnknownSpace unknown);

    /// The occupied cells; for UnknownSpace::pessimistic also the free cells.
    const std::shared_ptr<TexturedOcTree>& cells() const { return cells_; }

    /// Updates the obstacles after a change of the map.
    MapChange update(const TexturedOcTree& map, const MapChange& change);

    /// Treats cells as unknown until they are observed as free again. Is to be called for the cells
    /// above a new wall, which may have been observed as free before the wall appeared.
    MapChange forget(const TexturedOcTree& map, const std::vector<octomap::OcTreeKey>& cells);
    /// Ends the effect of forget() for the cells that a depth image shows to be free, with a
    /// surface behind them.
    MapChange remember(const TexturedOcTree& map, const ImageF& depth, const Camera& camera,
                       const Pose& T_c_w);

    /// For a camera that looks down: adds obstacles near the camera that the image hides. These are
    /// columns without any known cell whose floor lies within the image, but behind a nearer
    /// surface. Each of them and its neighbours within 5 cm count as occupied from `radius` below
    /// the camera upward.
    /// @param radius half the edge of the square around the camera that is searched [m]
    MapChange addHidden(const TexturedOcTree& map, const View& image, const Camera& camera,
                        const Pose& T_c_w, double radius);

    /// For UnknownSpace::pessimistic: frees the unknown cells of the body, and of as wide a way
    /// before the camera, which sees less than that right ahead of it.
    /// @param ahead_w end of this way; @param radius of the body [m]
    MapChange addBody(const TexturedOcTree& map, const Eigen::Vector3d& body_w,
                      const Eigen::Vector3d& ahead_w, double radius);

  private:
    bool set(const octomap::OcTreeKey& key, bool isOccupied);
    void store(const octomap::OcTreeKey& key, bool isOccupied);
    void updateColumn(const TexturedOcTree& map, const Eigen::Array2i& column, MapChange& changed);

    std::shared_ptr<TexturedOcTree> cells_;
    int lowest_, highest_;  // heights of the bricks that are updated
    UnknownSpace unknown_;
    std::unordered_set<octomap::OcTreeKey, octomap::OcTreeKey::KeyHash> forgotten_;
};

}  // namespace photonav
