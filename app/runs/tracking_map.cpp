// SPDX-License-Identifier: BSD-3-Clause
#include "runs/tracking_map.hpp"

#include "map/octree_file.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "scene/scene.hpp"

namespace photonav {

TrackingMap loadTrackingMap(const std::string& file) {
    TrackingMap map;
    if (isOcTreeFile(file)) {
        map.octree = loadTexturedOcTree(file);
        map.views = std::make_shared<VoxelRenderer>(*map.octree, UnknownPolicy::free);
        map.describe = [octree = map.octree](ReportData& report) {
            report.voxels = makeReportVoxels(*octree);
        };
        return map;
    }
    auto renderer = std::make_shared<MeshRenderer>(loadScene(file));
    map.describe = [mesh = renderer.get()](ReportData& report) {
        report.mesh = makeReportMesh(mesh->scene());
    };
    map.views = std::move(renderer);
    return map;
}

}  // namespace photonav
