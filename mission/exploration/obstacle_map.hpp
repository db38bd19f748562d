// SPDX-License-Identifier: BSD-3-Clause
// What a robot must not fly into, in a map that does not show everything.
#pragma once

#include <memory>
#include <unordered_set>

#include "config/explore_config.hpp"
#include "map/map_change.hpp"
#include "map/textured_octree.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Occupied cells of a column, one above the other, that go on upward.
inline constexpr int kWallCells = 4;

/// A camera that looks down sees the foot of a wall, but seldom the wall at the height at which the
/// robot flies. Obstacles are therefore continued upward: above at least four occupied cells of a
/// column, unknown cells count as occupied, until one that is known to be free. The highest surface
/// of a box has such a cell right above it.
///
/// Other unknown cells are free (optimistic) or occupied (pessimistic), except where the body is.
class ObstacleMap {
  public:
    /// @param bounds of the positions flown to [m]
    ObstacleMap(double resolution, const Eigen::AlignedBox3d& bounds, UnknownSpace unknown);

    /// The occupied cells, and with pessimistic the free ones.
    const std::shared_ptr<TexturedOcTree>& cells() const { return cells_; }

    /// @param change of the map
    /// @return bricks whose obstacles changed
    MapChange update(const TexturedOcTree& map, const MapChange& change);

    /// A wall has appeared below cells that may have been seen free before: until they are seen
    /// free again, nothing is known of them. @return bricks whose obstacles changed
    MapChange forget(const TexturedOcTree& map, const std::vector<octomap::OcTreeKey>& cells);
    /// An image shows surfaces behind forgotten cells.
    /// @return bricks whose obstacles changed
    MapChange remember(const TexturedOcTree& map, const ImageF& depth, const Camera& camera,
                       const Pose& T_c_w);

    /// Columns near a camera that looks down whose floor is in the image but hidden by a nearer
    /// surface, and of which nothing was seen. They and their eight neighbours count as occupied
    /// from `radius` below the camera upward.
    /// @param radius around the camera [m]
    /// @return bricks that changed
    MapChange addHidden(const TexturedOcTree& map, const View& image, const Camera& camera,
                        const Pose& T_c_w, double radius);

    /// Frees unknown cells where the body is. @return bricks that changed
    MapChange addBody(const TexturedOcTree& map, const Eigen::Vector3d& p_w, double radius);

  private:
    bool set(const octomap::OcTreeKey& key, bool isOccupied);
    void updateColumn(const TexturedOcTree& map, const Eigen::Array2i& column, MapChange& changed);

    std::shared_ptr<TexturedOcTree> cells_;
    int lowest_, highest_;  // bricks that obstacles are looked for in
    UnknownSpace unknown_;
    std::unordered_set<octomap::OcTreeKey, octomap::OcTreeKey::KeyHash> forgotten_;
};

}  // namespace photonav
