// SPDX-License-Identifier: BSD-3-Clause
#include "problem/world.hpp"

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "io/error.hpp"
#include "problem/map_of_config.hpp"
#include "problem/picture_from_above.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "scene/scene.hpp"

namespace photonav {
namespace {

/// Range of the clearance [m]: beyond the robot, but at most 150 cells.
double reach(double robotRadius, double cell) {
    return std::min(std::max(1., 2. * robotRadius), 150. * cell);
}

bool isTextured(const TexturedOcTree& map) {
    for (auto cell = map.begin_leafs(); cell != map.end_leafs(); ++cell) {
        if (cell->meanGrey()) return true;
    }
    return false;
}

Eigen::AlignedBox3d extentOf(const TexturedOcTree& map) {
    Eigen::AlignedBox3d box;
    map.getMetricMin(box.min().x(), box.min().y(), box.min().z());
    map.getMetricMax(box.max().x(), box.max().y(), box.max().z());
    return box;
}

}  // namespace

struct World::Collectors {
    std::mutex mutex;  // problems are made on several threads
    std::vector<std::weak_ptr<MapChange>> changes;
};

World::World(const Config& config) {
    if (!config.sceneFile.empty() && !config.mapFile.empty()) {
        throw config.invalid(
            "map.file",
            "not together with scene.file: only `photonav explore` takes both, the "
            "scene as the world and the map as what the robot knows of it");
    }
    const bool isScene = config.mapFile.empty();
    try {
        if (isScene) {
            useScene(loadScene(config.sceneFile), config);
        } else {
            const std::shared_ptr<TexturedOcTree> map = loadMapOf(config);
            hasTexture_ = isTextured(*map);
            views_ = std::make_shared<VoxelRenderer>(*map, config.unknownToCamera);
            useMap(map, map, config);
        }
    } catch (const InputError& error) {
        if (!isScene) throw;
        throw config.invalid("scene.file", error.what());
    } catch (const std::invalid_argument& error) {  // too large a grid for these bounds
        const char* key = isScene ? " (robot.clearance_resolution, at most 10 m)" : "";
        throw config.invalid("bounds", std::string(error.what()) + key);
    } catch (const std::bad_alloc&) {
        throw config.invalid("bounds", "the world within them needs more memory than there is");
    }
}

World::World(Scene scene, const Config& config) { useScene(std::move(scene), config); }

World::World(std::shared_ptr<const TexturedOcTree> map, const Config& config)
    : World(map, map, config) {}

World::World(std::shared_ptr<const TexturedOcTree> map,
             std::shared_ptr<const TexturedOcTree> obstacles, const Config& config)
    : snapshots_(std::in_place, *map, config.unknownToCamera),
      collectors_(std::make_shared<Collectors>()) {
    views_ = snapshots_->current();
    useMap(std::move(map), std::move(obstacles), config);
}

void World::useScene(Scene scene, const Config& config) {
    auto renderer = std::make_unique<MeshRenderer>(std::move(scene));
    scene_ = &renderer->scene();
    distances_ =
        DistanceMap(*scene_, config.clearanceResolution, config.bounds,
                    {.maxDistance = reach(config.robotRadius, config.clearanceResolution)});
    views_ = std::move(renderer);
}

void World::useMap(std::shared_ptr<const TexturedOcTree> map,
                   std::shared_ptr<const TexturedOcTree> obstacles, const Config& config) {
    distances_ = DistanceMap(*obstacles, config.bounds,
                             {.maxDistance = reach(config.robotRadius, map->getResolution()),
                              .unknown = config.unknownToPlanner});
    map_ = std::move(map);
    obstacles_ = std::move(obstacles);
}

void World::mapChanged(const MapChange& change) {
    if (!snapshots_) throw std::logic_error("world: only a map of the program's own can change");
    if (change.empty()) return;
    {  // first: planners must hear of a wall even if a map has become too large for views
        const std::lock_guard lock(collectors_->mutex);
        auto& changes = collectors_->changes;
        std::erase_if(changes, [](const auto& collected) { return collected.expired(); });
        for (const auto& collected : changes) collected.lock()->join(change);
    }
    distances_.update(*obstacles_, change);
    views_ = snapshots_->update(*map_, change);
}

std::shared_ptr<MapChange> World::collectChanges() const {
    auto collected = std::make_shared<MapChange>();
    if (!collectors_) return collected;
    const std::lock_guard lock(collectors_->mutex);
    collectors_->changes.emplace_back(collected);
    return collected;
}

std::optional<DistanceMap> World::distancesWithoutUnknown(const Config& config) const {
    if (!obstacles_ || config.unknownToPlanner == UnknownPolicy::free) return {};
    return DistanceMap(*obstacles_, config.bounds,
                       {.maxDistance = distances_.maxDistance(), .unknown = UnknownPolicy::free});
}

Eigen::AlignedBox3d World::extent() const {
    return scene_ != nullptr ? scene_->boundingBox() : extentOf(*map_);
}

ImageF World::pictureFromAbove(const Eigen::AlignedBox2d& area, double z, double pixelSize) const {
    return photonav::pictureFromAbove(*views_, area, z, extent().min().z(), pixelSize,
                                      scene_ ? scene_->solids : std::vector<Prism>());
}

}  // namespace photonav
