// SPDX-License-Identifier: BSD-3-Clause
// Views of a textured octree.
#pragma once

#include <utility>

#include "map/textured_octree.hpp"
#include "photometry/view.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// Predicts views from a snapshot of a map. Making one takes milliseconds per million cells of the
/// map's bounding box; VoxelSnapshots makes them for a map that changes.
///
/// A ray ends at the first surface: in an occupied cell at the planes that its faces have learnt
/// (CellSurfaces), or, where there are none, at the face through which it enters. It goes on where
/// it misses the planes; a cell whose surfaces all look away ends it at its face. In unknown space
/// it continues (UnknownPolicy::free) or ends without a surface (UnknownPolicy::occupied). There is
/// no surface outside the map's bounding box, and none in views from inside a solid. The grey value
/// of the cell's face is interpolated bilinearly between neighbouring faces of the surface (also
/// over steps of one cell), so that cell edges do not show. A face that was never observed takes
/// the mean of its cell's observed faces; a cell without any has no depth in the view (0), since
/// its grey value is unknown.
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
