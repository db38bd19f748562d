// SPDX-License-Identifier: BSD-3-Clause
#include "tracking_map.hpp"

#include "mesh_renderer.hpp"
#include "octree_file.hpp"
#include "scene.hpp"
#include "voxel_renderer.hpp"

namespace photonav {

TrackingMap loadTrackingMap(const std::string& file) {
    TrackingMap map;
    if (isOcTreeFile(file)) {
        map.octree = loadTexturedOcTree(file);
        map.views = std::make_unique<VoxelRenderer>(*map.octree, UnknownPolicy::free);
        map.describe = [octree = map.octree](ReportData& report) {
            report.voxels = makeReportVoxels(*octree);
        };
        return map;
    }
    auto renderer = std::make_unique<MeshRenderer>(loadScene(file));
    map.describe = [mesh = renderer.get()](ReportData& report) {
        report.mesh = makeReportMesh(mesh->scene());
    };
    map.views = std::move(renderer);
    return map;
}

}  // namespace photonav
