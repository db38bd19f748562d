// SPDX-License-Identifier: BSD-3-Clause
// Views of a textured octree.
#pragma once

#include <utility>

#include "map/textured_octree.hpp"
#include "photometry/view.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// Predicts views from a snapshot of a map. VoxelSnapshots makes them for a map that changes; a new
/// one takes milliseconds per million cells of the map's bounding box.
///
/// A ray ends at the first occupied cell. Where it first meets unknown space, `unknown` decides:
/// free, and it goes on; occupied, and it ends there without a surface. Outside the map's bounding
/// box is no surface either, nor inside a solid. The grey value of the cell's face is interpolated
/// bilinearly between neighbouring faces of the surface (also over steps of one cell), so that cell
/// edges do not show. A face that was never observed takes the mean of its cell's observed faces;
/// a cell without any has no depth in the view (0), since its grey value is unknown.
class VoxelRenderer : public ViewSource {
  public:
    /// @throws std::invalid_argument when the map's bounding box has more than 2^31 cells
    VoxelRenderer(const TexturedOcTree& map, UnknownPolicy unknown);
    explicit VoxelRenderer(VoxelGrid grid) : grid_(std::move(grid)) {}

    /// @throws std::invalid_argument when the pose is not finite
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    friend class VoxelSnapshots;  // which changes those that nobody holds

    VoxelGrid grid_;
};

}  // namespace photonav
