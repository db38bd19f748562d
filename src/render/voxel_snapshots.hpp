// SPDX-License-Identifier: BSD-3-Clause
// Renderers of a map that changes.
#pragma once

#include <deque>
#include <memory>

#include "map/map_change.hpp"
#include "render/voxel_grid_builder.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav {

/// Makes renderers of a map that changes. Each renderer shows the map at the time of one update and
/// does not change while it is in use. A renderer that is no longer in use is updated and returned
/// again, so that the cost of an update grows with the size of the change, not of the map.
/// Therefore, do not keep old renderers longer than needed.
///
/// update() must not run while the map is written. Other threads may use and release renderers at
/// any time.
class VoxelSnapshots {
  public:
    /// @throws std::invalid_argument when the map's bounding box has more than 2^31 cells
    VoxelSnapshots(const TexturedOcTree& map, UnknownPolicy unknown);

    /// The renderer of the map at the last update; never null.
    const std::shared_ptr<const VoxelRenderer>& current() const { return current_; }

    /// A renderer of the present map, which becomes current(). Its views are bit-identical to those
    /// of a new VoxelRenderer of the map.
    /// @param change everything that changed in the map since the last update
    /// @throws std::invalid_argument when the map has grown too large (see above), or when the
    ///        change is of another resolution
    std::shared_ptr<const VoxelRenderer> update(const TexturedOcTree& map, const MapChange& change);

  private:
    struct Spares;

    VoxelSnapshots(const TexturedOcTree& map, UnknownPolicy unknown,
                   std::unique_ptr<VoxelRenderer> first);
    std::unique_ptr<VoxelRenderer> copyOfCurrent() const;
    std::shared_ptr<const VoxelRenderer> share(std::unique_ptr<VoxelRenderer> renderer);

    VoxelGridBuilder builder_;
    std::shared_ptr<Spares> spares_;
    std::size_t version_ = 0;         // of current_, which is made with it
    std::deque<GridUpdate> updates_;  // the last ones, that of version_ at the back
    std::shared_ptr<const VoxelRenderer> current_;
};

}  // namespace photonav
