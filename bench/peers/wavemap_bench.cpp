// SPDX-License-Identifier: BSD-3-Clause
// Our integration of depth images beside wavemap's, on the same frames: processor time, memory, and
// where the two maps agree.
// Usage: wavemap_bench [RECORDING] [RESOLUTION=0.05] [EVERY=1]
#include <wavemap/core/integrator/measurement_model/continuous_ray.h>
#include <wavemap/core/integrator/projection_model/pinhole_camera_projector.h>
#include <wavemap/core/integrator/projective/coarse_to_fine/hashed_chunked_wavelet_integrator.h>
#include <wavemap/core/map/hashed_chunked_wavelet_octree.h>
#include <wavemap/core/utils/iterate/grid_iterator.h>
#include <wavemap/core/utils/query/occupancy_classifier.h>

#include "peer_maps.hpp"

using namespace photonav;
using namespace photonav::peers;

namespace {

using WaveletMap = wavemap::HashedChunkedWaveletOctree;
using WaveletIntegrator = wavemap::HashedChunkedWaveletIntegrator;

/// Options as in wavemap's own configuration for depth cameras
/// (wavemap_panoptic_mapping_rgbd.yaml), where the standard deviation of ranges is half a cell; one
/// thread.
WaveletIntegrator makeIntegrator(const Camera& camera, const FusionOptions& options,
                                 const WaveletMap::Ptr& map) {
    const auto real = [](double x) { return static_cast<float>(x); };
    const auto projector =
        std::make_shared<wavemap::PinholeCameraProjector>(wavemap::PinholeCameraProjectorConfig(
            real(camera.fx()), real(camera.fy()), real(camera.cx()), real(camera.cy()),
            static_cast<int>(camera.height), static_cast<int>(camera.width)));
    const auto image = std::make_shared<wavemap::PosedImage<>>(projector->getDimensions());
    const auto offsets =
        std::make_shared<wavemap::Image<wavemap::Vector2D>>(projector->getDimensions());
    const wavemap::ContinuousRayConfig ray(map->getMinCellWidth() / 2.F, 0.2F, 0.4F);
    return {wavemap::ProjectiveIntegratorConfig(real(options.minRange), real(options.maxRange)),
            projector,
            image,
            offsets,
            std::make_shared<wavemap::ContinuousRay>(ray, projector, image),
            map,
            std::make_shared<wavemap::ThreadPool>(1)};
}

/// Images of wavemap are indexed by (u, v). Depths below its least range count as not measured.
wavemap::PosedImage<> depthImageOf(const RecordedFrame& frame, const Camera& camera) {
    const Pose T_w_c = frame.T_c_w.inverse();
    const Eigen::Quaternionf rotation(Eigen::Quaterniond(T_w_c.rotation()).cast<float>());
    const wavemap::Transformation3D pose(wavemap::Rotation3D(rotation.normalized()),
                                         wavemap::Point3D(T_w_c.translation().cast<float>()));
    wavemap::PosedImage<> image(static_cast<int>(camera.width), static_cast<int>(camera.height));
    image.setPose(pose);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            image.getData()(u, v) = static_cast<float>(frame.view.depth[v][u]);
        }
    }
    return image;
}

/// Log-odds are limited every 2 s of the recording, nodes pruned every 10 s and in the end, as in
/// wavemap's configurations.
Effort integrateByWavemap(const Recording& recording, const FusionOptions& options,
                          const WaveletMap::Ptr& map) {
    const Camera& camera = recording.sequence.camera;
    WaveletIntegrator integrator = makeIntegrator(camera, options, map);
    const double last = recording.sequence.frames.back().timestamp;
    double limited = recording.sequence.frames.front().timestamp, pruned = limited;
    return effortOf(recording, [&](const RecordedFrame& frame) {
        integrator.integrate(depthImageOf(frame, camera));
        if (frame.timestamp >= limited + 2.) {
            map->threshold();
            limited = frame.timestamp;
        }
        if (frame.timestamp >= pruned + 10. || frame.timestamp >= last) {
            map->prune();
            pruned = frame.timestamp;
        }
    });
}

/// Log-odds within 0.001 of 0 are unknown: wavelets round.
Cell stateOf(float logOdds) {
    if (wavemap::OccupancyClassifier::isUnobserved(logOdds)) return Cell::unknown;
    return logOdds > 0.F ? Cell::occupied : Cell::free;
}

/// Visits the leaves that are not unknown: work(index, state).
template <typename Work>
void forEachKnownLeaf(const WaveletMap& map, const Work& work) {
    map.forEachLeaf([&](const wavemap::OctreeIndex& index, float logOdds) {
        if (stateOf(logOdds) != Cell::unknown) work(index, stateOf(logOdds));
    });
}

std::size_t countKnownLeaves(const WaveletMap& map) {
    std::size_t count = 0;
    forEachKnownLeaf(map, [&](const wavemap::OctreeIndex&, Cell) { ++count; });
    return count;
}

/// wavemap's cell that has the same centre: cells of both maps have corners at whole multiples of
/// the resolution.
wavemap::Index3D indexOf(const TexturedOcTree& ours, const octomap::OcTreeKey& key) {
    const octomap::point3d centre = ours.keyToCoord(key);
    return wavemap::convert::pointToFloorIndex<3>({centre.x(), centre.y(), centre.z()},
                                                  1.F / static_cast<float>(ours.getResolution()));
}

Agreement compare(TexturedOcTree& ours, const WaveletMap& theirs) {
    Agreement agreement;
    forEachCell(ours, [&](const octomap::OcTreeKey& key, Cell cell) {
        agreement.add(cell, stateOf(theirs.getCellValue(indexOf(ours, key))));
    });
    forEachKnownLeaf(theirs, [&](const wavemap::OctreeIndex& leaf, Cell cell) {
        for (const wavemap::Index3D& index :
             wavemap::Grid(wavemap::convert::nodeIndexToMinCornerIndex(leaf),
                           wavemap::convert::nodeIndexToMaxCornerIndex(leaf))) {
            const Eigen::Vector3d p = ours.getResolution() * (index.cast<double>().array() + 0.5);
            if (cellOf(ours, ours.coordToKey(p.x(), p.y(), p.z())) == Cell::unknown) {
                agreement.add(Cell::unknown, cell);
            }
        }
    });
    return agreement;
}

/// wavemap's surfaces begin at the measured depth, ours fill the cell around it: where we say
/// occupied and wavemap free, a cell next to it should be occupied in wavemap's map.
void printTouching(TexturedOcTree& ours, const WaveletMap& theirs) {
    const wavemap::Index3D one = wavemap::Index3D::Ones();
    std::size_t cells = 0, touching = 0;
    forEachCell(ours, [&](const octomap::OcTreeKey& key, Cell cell) {
        const wavemap::Index3D index = indexOf(ours, key);
        if (cell != Cell::occupied || stateOf(theirs.getCellValue(index)) != Cell::free) return;
        ++cells;
        bool touches = false;
        for (const wavemap::Index3D& next : wavemap::Grid<3>(index - one, index + one)) {
            touches = touches || stateOf(theirs.getCellValue(next)) == Cell::occupied;
        }
        touching += touches ? 1 : 0;
    });
    fmt::print(
        "of the {} cells that are occupied in ours and free in wavemap's, {} touch a cell that "
        "is occupied in wavemap's\n",
        cells, touching);
}

void compareWithWavemap(const Recording& recording, const FusionOptions& fusion,
                        TexturedOcTree& ours) {
    wavemap::HashedChunkedWaveletOctreeConfig config;
    config.min_cell_width = static_cast<float>(ours.getResolution());
    const auto theirs = std::make_shared<WaveletMap>(config);
    const Effort effort = integrateByWavemap(recording, fusion, theirs);
    printRow("wavemap, chunked wavelet octree", effort, countKnownLeaves(*theirs));
    print(compare(ours, *theirs), "wavemap's");
    printTouching(ours, *theirs);
}

}  // namespace

int main(int argc, char** argv) {
    return runComparison(argc, argv, "wavemap_bench", compareWithWavemap);
}
