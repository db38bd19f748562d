// SPDX-License-Identifier: BSD-3-Clause
// Makes the grid of a map, and updates it when the map changes.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "map/map_change.hpp"
#include "render/brick_surface.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// The parts of a grid that an update has rewritten, for updates of copies of the grid. Bricks are
/// given by their index in the world, because the first cell of a grid that grows may change.
struct GridUpdate {
    CellBox boxes;  ///< box of bricks whose VoxelGrid::ends and VoxelGrid::boxes were rewritten
    std::vector<Eigen::Array3i> bricks;  ///< bricks whose textures were rewritten
};

/// Applies an update to `copy`, which was equal to `grid` before the update. Several updates are
/// applied in their order.
void copyUpdate(const VoxelGrid& grid, const GridUpdate& update, VoxelGrid& copy);

/// Fills a grid from a map and updates it after changes of the map. Stores the content of every
/// brick with a surface, so that only changed bricks are read from the map again.
class VoxelGridBuilder {
  public:
    /// Fills `grid` from a map.
    /// @throws std::invalid_argument when the map's bounding box has more than 2^31 cells
    VoxelGridBuilder(const TexturedOcTree& map, UnknownPolicy unknown, VoxelGrid& grid);

    /// Updates the grid that this builder has filled. The result equals a new grid of the map.
    /// @param change everything that changed in the map since the last call
    /// @throws std::invalid_argument as above, or when the change is of another resolution
    GridUpdate update(const TexturedOcTree& map, const MapChange& change, VoxelGrid& grid);

  private:
    using Bricks = std::vector<Eigen::Array3i>;

    void readAll(const TexturedOcTree& map, const TexturedOcTreeNode& node,
                 const Eigen::Array3i& lowest, int edge, VoxelGrid& grid, Bricks& changed);
    void grow(const CellBox& box, VoxelGrid& grid, Bricks& toRead) const;
    void refreshPatches(const Bricks& changed, VoxelGrid& grid, Bricks& rewritten);
    bool setSurface(std::size_t brick, const BrickSurface& surface, VoxelGrid& grid);
    void setPlanes(std::int32_t textures, VoxelGrid& grid);
    void makePatches(const SurfaceNeighbours& neighbours, std::int32_t textures, VoxelGrid& grid);
    SurfaceNeighbours neighboursOf(const Eigen::Array3i& brick, const VoxelGrid& grid) const;

    bool unknownEndsRays_;
    std::deque<BrickSurface> surfaces_{1};  // index as in VoxelGrid::brickTextures
    std::vector<std::int32_t> freePatches_;
    std::vector<std::uint32_t> freeSeveral_;
};

}  // namespace photonav
