// SPDX-License-Identifier: BSD-3-Clause
// Views of a textured octree.
#pragma once

#include <utility>

#include "map/textured_octree.hpp"
#include "photometry/view.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// Predicts views from a snapshot of a map. A snapshot takes milliseconds per million cells of the
/// map's bounding box; VoxelSnapshots makes snapshots of a map that changes.
///
/// A ray ends at the first surface. In an occupied cell these are the planes inside the cell
/// (CellSurfaces); if there are none, it is the face through which the ray enters. A ray that
/// misses the planes continues; if all planes of a cell face away from the ray, it ends at the face
/// of the cell. In unknown space a ray continues (UnknownPolicy::free) or ends without a surface
/// (UnknownPolicy::occupied). There is no surface outside the map's bounding box, and none in views
/// from inside a solid. The grey value of the cell's face is interpolated bilinearly between
/// neighbouring faces of the surface (also across steps of one cell), so that cell edges are not
/// visible. A face that was never observed takes the mean grey value of the observed faces of its
/// cell. A cell without observed faces has no depth in the view (0), because its grey value is
/// unknown.
class VoxelRenderer : public ViewSource {
  public:
    /// @throws std::invalid_argument when the map's bounding box has more than 2^31 cells
    VoxelRenderer(const TexturedOcTree& map, UnknownPolicy unknown);
    explicit VoxelRenderer(VoxelGrid grid) : grid_(std::move(grid)) {}

    /// @throws std::invalid_argument when the pose is not finite
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    friend class VoxelSnapshots;  // which updates renderers that are not in use

    VoxelGrid grid_;
};

}  // namespace photonav
