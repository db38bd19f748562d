// SPDX-License-Identifier: BSD-3-Clause
#include "problem/tracking_map.hpp"

#include "io/reading.hpp"
#include "map/octree_file.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav {

TrackingMap loadTrackingMap(const std::string& file) {
    return reading(file, [&] {
        TrackingMap map;
        if (isOcTreeFile(file)) {
            map.octree = loadTexturedOcTree(file);
            map.kind = map.octree->hasSurfaces() ? MapKind::surfaces : MapKind::cells;
            map.views = std::make_shared<VoxelRenderer>(*map.octree, UnknownPolicy::free);
            return map;
        }
        const auto renderer = std::make_shared<MeshRenderer>(loadScene(file));
        map.scene = {renderer, &renderer->scene()};
        map.views = renderer;
        return map;
    });
}

}  // namespace photonav
