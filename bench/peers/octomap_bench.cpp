// SPDX-License-Identifier: BSD-3-Clause
// Our integration of depth images beside OctoMap's own, on the same frames: processor time, memory,
// and where the two maps agree.
// Usage: octomap_bench [RECORDING] [RESOLUTION=0.05] [EVERY=1]
#include <octomap/OcTree.h>

#include "peer_maps.hpp"

using namespace photonav;
using namespace photonav::peers;

namespace {

/// The points of a depth image within the ranges of our fusion, in the world.
octomap::Pointcloud pointsOf(const RecordedFrame& frame, const Camera& camera,
                             const FusionOptions& options) {
    const Pose T_w_c = frame.T_c_w.inverse();
    octomap::Pointcloud points;
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const double z = frame.view.depth[v][u];
            if (!(z >= options.minRange)) continue;
            const Eigen::Vector3f p = (T_w_c * camera.unproject(u, v, z)).cast<float>();
            points.push_back(p.x(), p.y(), p.z());
        }
    }
    return points;
}

octomap::point3d originOf(const RecordedFrame& frame) {
    const Eigen::Vector3f p = frame.T_c_w.inverse().translation().cast<float>();
    return {p.x(), p.y(), p.z()};
}

/// @param isDiscrete a ray per end cell, as ours; otherwise one per pixel
Effort integrateByOctomap(const Recording& recording, const FusionOptions& options, bool isDiscrete,
                          octomap::OcTree& map) {
    return effortOf(recording, [&](const RecordedFrame& frame) {
        map.insertPointCloud(pointsOf(frame, recording.sequence.camera, options), originOf(frame),
                             options.maxRange, false, isDiscrete);
    });
}

Agreement compare(TexturedOcTree& ours, octomap::OcTree& theirs) {
    Agreement agreement;
    forEachCell(ours, [&](const octomap::OcTreeKey& key, Cell cell) {
        agreement.add(cell, cellOf(theirs, key));
    });
    forEachCell(theirs, [&](const octomap::OcTreeKey& key, Cell cell) {
        if (cellOf(ours, key) == Cell::unknown) agreement.add(Cell::unknown, cell);
    });
    return agreement;
}

void compareWithOctomap(const Recording& recording, const FusionOptions& fusion,
                        TexturedOcTree& ours) {
    octomap::OcTree theirs(ours.getResolution()), discrete(ours.getResolution());
    const Effort perPixel = integrateByOctomap(recording, fusion, false, theirs);
    printRow("OctoMap, a ray per pixel", perPixel, theirs.getNumLeafNodes());
    const Effort perCell = integrateByOctomap(recording, fusion, true, discrete);
    printRow("OctoMap, a ray per end cell", perCell, discrete.getNumLeafNodes());
    print(compare(ours, theirs), "OctoMap's with a ray per pixel");
}

}  // namespace

int main(int argc, char** argv) {
    return runComparison(argc, argv, "octomap_bench", compareWithOctomap);
}
