// SPDX-License-Identifier: BSD-3-Clause
// Views of a map that changes.
#pragma once

#include <deque>
#include <memory>

#include "map/map_change.hpp"
#include "render/voxel_grid_builder.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav {

/// Renderers of a map as it was at one time each. A renderer never changes while anyone holds it.
/// One that nobody holds any more is brought up to date and handed out again, so that an update
/// costs what changed in the map, not the map: do not hold old ones for longer than needed.
///
/// update() must not run while the map is written. Handing renderers to other threads, and letting
/// go of them there, is safe at any time.
class VoxelSnapshots {
  public:
    /// @throws std::invalid_argument when the map's bounding box has more than 2^31 cells
    VoxelSnapshots(const TexturedOcTree& map, UnknownPolicy unknown);

    /// Of the map at the last update; never null.
    const std::shared_ptr<const VoxelRenderer>& current() const { return current_; }

    /// Follows the map. Views of the renderer that is returned equal those of a VoxelRenderer made
    /// from the map now, to the bit.
    /// @param change all that changed in the map since the last update
    /// @throws std::invalid_argument when the map has grown too large (see above), or when the
    /// change is of another resolution
    std::shared_ptr<const VoxelRenderer> update(const TexturedOcTree& map, const MapChange& change);

  private:
    struct Spares;

    VoxelSnapshots(const TexturedOcTree& map, UnknownPolicy unknown,
                   std::unique_ptr<VoxelRenderer> first);
    std::unique_ptr<VoxelRenderer> copyOfCurrent() const;
    std::shared_ptr<const VoxelRenderer> handOut(std::unique_ptr<VoxelRenderer> renderer);

    VoxelGridBuilder builder_;
    std::shared_ptr<Spares> spares_;
    std::size_t version_ = 0;         // of current_, which is made with it
    std::deque<GridUpdate> updates_;  // the last ones, that of version_ at the back
    std::shared_ptr<const VoxelRenderer> current_;
};

}  // namespace photonav
