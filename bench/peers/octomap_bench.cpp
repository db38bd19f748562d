// SPDX-License-Identifier: BSD-3-Clause
// Our integration of depth images beside OctoMap's own, on the same frames: processor time, memory,
// and where the two maps agree.
// Usage: octomap_bench [DATASET [resolution [every]]]
#include <fmt/format.h>
#include <malloc.h>
#include <octomap/OcTree.h>

#include <array>
#include <cstdlib>

#include "../thread_time.hpp"
#include "io/error.hpp"
#include "map/map_fusion.hpp"
#include "recording/recording.hpp"

using namespace photonav;

namespace {

enum class Cell : std::uint8_t { unknown, free, occupied };
constexpr std::array kNames{"unknown", "free", "occupied"};
constexpr double kMegabyte = 1024. * 1024.;

template <typename Tree>
Cell cellOf(const Tree& tree, const octomap::OcTreeKey& key) {
    const auto* node = tree.search(key);
    if (!node) return Cell::unknown;
    return tree.isNodeOccupied(*node) ? Cell::occupied : Cell::free;
}

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

/// Processor time and memory of an integration.
struct Effort {
    double milliseconds = 0.;  ///< an image, on average
    double megabytes = 0.;     ///< on the heap, in the end
};

double heapMegabytes() {
    const auto heap = mallinfo2();
    return static_cast<double>(heap.uordblks + heap.hblkhd) / kMegabyte;
}

/// @param integrate one image into a map
template <typename Integrate>
Effort effortOf(const Recording& recording, const Integrate& integrate) {
    Effort effort;
    const double before = heapMegabytes();
    for (std::size_t i = 0; i < recording.sequence.frames.size(); ++i) {
        const RecordedFrame frame = recording.load(i);
        const double begun = threadTime();
        integrate(frame);
        effort.milliseconds += threadTime() - begun;
    }
    effort.milliseconds /= static_cast<double>(recording.sequence.frames.size());
    effort.megabytes = heapMegabytes() - before;
    return effort;
}

/// @param isDiscrete a ray per end cell, as ours; otherwise one per pixel
Effort integrateByOctomap(const Recording& recording, const FusionOptions& options, bool isDiscrete,
                          octomap::OcTree& map) {
    return effortOf(recording, [&](const RecordedFrame& frame) {
        map.insertPointCloud(pointsOf(frame, recording.sequence.camera, options), originOf(frame),
                             options.maxRange, false, isDiscrete);
    });
}

/// How many cells are in each pair of states. Cells that neither map knows are not counted.
using Agreement = std::array<std::array<std::size_t, 3>, 3>;  // [ours][OctoMap's]

/// Expands both maps: leaves become cells.
Agreement compare(TexturedOcTree& ours, octomap::OcTree& theirs) {
    Agreement counts{};
    const auto forEachCell = [](auto& tree, const auto& work) {
        tree.expand();
        for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
            work(leaf.getKey(), tree.isNodeOccupied(*leaf) ? Cell::occupied : Cell::free);
        }
    };
    const auto at = [](Cell cell) { return static_cast<std::size_t>(cell); };
    forEachCell(ours, [&](const octomap::OcTreeKey& key, Cell cell) {
        ++counts[at(cell)][at(cellOf(theirs, key))];
    });
    forEachCell(theirs, [&](const octomap::OcTreeKey& key, Cell cell) {
        if (cellOf(ours, key) == Cell::unknown) ++counts[at(Cell::unknown)][at(cell)];
    });
    return counts;
}

void print(const Agreement& counts) {
    fmt::print("\ncells: ours (rows) against OctoMap's with a ray per pixel\n{:<12}", "");
    for (const char* name : kNames) fmt::print("{:>12}", name);
    std::size_t known = 0, agreed = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        fmt::print("\n{:<12}", kNames[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            fmt::print("{:>12}", counts[i][k]);
            if (i == 0 || k == 0) continue;
            known += counts[i][k];
            agreed += i == k ? counts[i][k] : 0;
        }
    }
    fmt::print("\nagree in {:.2f} % of the {} cells that both know\n",
               100. * static_cast<double>(agreed) / static_cast<double>(known), known);
}

void run(const RecordingOptions& options, double resolution) {
    const Recording recording = readRecording(options);
    const Camera& camera = recording.sequence.camera;
    const FusionOptions fusion;
    fmt::print("{}: {} images of {}x{}, cells of {} m, up to {} m\n\n", options.dataset,
               recording.sequence.frames.size(), camera.width, camera.height, resolution,
               fusion.maxRange);
    fmt::print("{:<40}{:>12}{:>10}{:>12}\n", "", "ms an image", "MB", "leaves");
    const auto row = [](const char* name, const Effort& effort, const auto& tree) {
        fmt::print("{:<40}{:>12.2f}{:>10.2f}{:>12}\n", name, effort.milliseconds, effort.megabytes,
                   tree.getNumLeafNodes());
    };
    TexturedOcTree ours(resolution);
    const Effort own = effortOf(recording, [&](const RecordedFrame& frame) {
        fuse(ours, frame.view, camera, frame.T_c_w, fusion);
    });
    row("ours (grey values and surfaces as well)", own, ours);
    octomap::OcTree theirs(resolution), discrete(resolution);
    row("OctoMap, a ray per pixel", integrateByOctomap(recording, fusion, false, theirs), theirs);
    row("OctoMap, a ray per end cell", integrateByOctomap(recording, fusion, true, discrete),
        discrete);
    print(compare(ours, theirs));
}

}  // namespace

int main(int argc, char** argv) {
    RecordingOptions options;
    options.dataset = argc > 1 ? argv[1] : PHOTONAV_SOURCE_DIR "/data/flight_front45";
    const double resolution = argc > 2 ? std::atof(argv[2]) : 0.05;
    if (argc > 3) options.every = std::max(1, std::atoi(argv[3]));
    try {
        run(options, resolution);
        return 0;
    } catch (const InputError& error) {
        fmt::print(stderr, "octomap_bench: {}\n", error.what());
        return 2;
    }
}
