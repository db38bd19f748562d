// SPDX-License-Identifier: BSD-3-Clause
// The scene or map of a config, which renders views and measures clearance.
#pragma once

#include <memory>
#include <optional>

#include "config/config.hpp"
#include "map/distance_map.hpp"
#include "photometry/view.hpp"
#include "render/voxel_snapshots.hpp"
#include "scene/scene.hpp"

namespace photonav {

class World {
  public:
    /// Loads the scene or map of the config.
    /// @throws InputError if it cannot be read, if the bounds are too large for the resolution, and
    ///         for a config with both
    explicit World(const Config& config);
    /// A world made from a given scene; clearance is measured within the bounds of the config.
    World(Scene scene, const Config& config);
    /// A world made from a given map; clearance is measured within the bounds of the config. The
    /// caller may change the map (occupancy and texture) and must then call mapChanged().
    /// @throws std::invalid_argument if the bounds are too large for the resolution of the map
    World(std::shared_ptr<const TexturedOcTree> map, const Config& config);
    /// As above, but obstacles are the occupied cells of another map of the same resolution.
    /// The change given to mapChanged() must list the changes of both maps.
    World(std::shared_ptr<const TexturedOcTree> map,
          std::shared_ptr<const TexturedOcTree> obstacles, const Config& config);

    /// Updates clearance and views after a change of the map, in a time that grows with the change.
    /// The world must not be used by other threads during the call. Planning problems in the world
    /// are updated by PlanningProblem::followMap().
    /// @param change everything that changed since the last call
    /// @throws std::logic_error unless the world was made from a given map
    void mapChanged(const MapChange& change);

    /// Registers a collector of changes: all later changes of the map are joined into the value
    /// returned, which the caller may empty at any time. It stays empty if the map cannot change.
    std::shared_ptr<MapChange> collectChanges() const;

    /// Renders views of the present scene or map.
    const ViewSource& views() const { return *views_; }
    /// views() with shared ownership.
    std::shared_ptr<const ViewSource> sharedViews() const { return views_; }
    /// Whether any surface has a grey value: false for a map of occupancy only.
    bool hasTexture() const { return hasTexture_; }
    /// Distance from a place to the nearest obstacle [m], see DistanceMap::clearance().
    double clearance(const Eigen::Vector3d& p_w) const { return distances_.clearance(p_w); }

    /// Distances to the occupied cells alone. Nothing if unknown cells are no obstacles anyway.
    /// @param config from which the world was made
    std::optional<DistanceMap> distancesWithoutUnknown(const Config& config) const;

    /// Bounding box of the scene or map, world frame [m]. For a map, visits all cells.
    Eigen::AlignedBox3d extent() const;

    /// The scene from which the world was made; null if it was made from a map.
    const Scene* scene() const { return scene_; }
    /// The map from which the world was made; null if it was made from a scene.
    const TexturedOcTree* map() const { return map_.get(); }

    /// The surfaces below a height z [m] from above: see problem/picture_from_above.hpp.
    ImageF pictureFromAbove(const Eigen::AlignedBox2d& area, double z, double pixelSize) const;

  private:
    /// The collectors of changes.
    struct Collectors;

    void useScene(Scene scene, const Config& config);
    void useMap(std::shared_ptr<const TexturedOcTree> map,
                std::shared_ptr<const TexturedOcTree> obstacles, const Config& config);

    std::shared_ptr<const ViewSource> views_;
    std::optional<VoxelSnapshots> snapshots_;  // source of views_, if the map may change
    std::shared_ptr<Collectors> collectors_;   // not null if the map may change
    bool hasTexture_ = true;
    DistanceMap distances_;
    std::shared_ptr<const TexturedOcTree> map_;
    std::shared_ptr<const TexturedOcTree> obstacles_;
    const Scene* scene_ = nullptr;  // owned by the renderer in views_
};

}  // namespace photonav
