// SPDX-License-Identifier: BSD-3-Clause
// The scene or map of a config, with its views and clearance.
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
    /// @throws InputError when it cannot be read, or is too large for the resolution asked for
    explicit World(const Config& config);
    /// A scene of the program's own, in the bounds of the config.
    World(Scene scene, const Config& config);
    /// A map of the program's own, in the bounds of the config. It may change and gain texture:
    /// call mapChanged() then.
    /// @throws std::invalid_argument for a map that is too large
    World(std::shared_ptr<const TexturedOcTree> map, const Config& config);
    /// The same where obstacles are the occupied cells of another map, of the same resolution. A
    /// change must list what changed in either.
    World(std::shared_ptr<const TexturedOcTree> map,
          std::shared_ptr<const TexturedOcTree> obstacles, const Config& config);

    /// Updates clearance and views after a change of the program's own map, at a cost that grows
    /// with the change. Nothing else may use the world meanwhile. Planning problems in it follow
    /// when PlanningProblem::followMap() is called.
    /// @param change everything that changed since the last call
    /// @throws std::logic_error for a world made otherwise
    void mapChanged(const MapChange& change);

    /// The map's changes, from now on until they are taken out, are joined in the value returned.
    /// Nothing is ever added where the map cannot change.
    std::shared_ptr<MapChange> collectChanges() const;

    const ViewSource& views() const { return *views_; }
    /// The same with shared ownership.
    std::shared_ptr<const ViewSource> sharedViews() const { return views_; }
    /// Whether any surface has a grey value: false for a map of occupancy only.
    bool hasTexture() const { return hasTexture_; }
    double clearance(const Eigen::Vector3d& p_w) const { return distances_.clearance(p_w); }

    /// Box of everything that can be seen [m]. Goes through all cells of a map.
    Eigen::AlignedBox3d extent() const;

    /// The scene or the map that the world was made from; null if it was made from the other.
    const Scene* scene() const { return scene_; }
    const TexturedOcTree* map() const { return map_.get(); }

    /// The grey values below height z, from above, nearly orthographic: first row at the largest y.
    ImageF pictureFromAbove(const Eigen::AlignedBox2d& area, double z, double pixelSize) const;

  private:
    /// Those who collect changes.
    struct Collectors;

    void useScene(Scene scene, const Config& config);
    void useMap(std::shared_ptr<const TexturedOcTree> map,
                std::shared_ptr<const TexturedOcTree> obstacles, const Config& config);

    std::shared_ptr<const ViewSource> views_;
    std::optional<VoxelSnapshots> snapshots_;  // that views_ is of, where the map may change
    std::shared_ptr<Collectors> collectors_;   // there, too
    bool hasTexture_ = true;
    DistanceMap distances_;
    std::shared_ptr<const TexturedOcTree> map_;
    std::shared_ptr<const TexturedOcTree> obstacles_;
    const Scene* scene_ = nullptr;  // of the renderer in views_
};

}  // namespace photonav
