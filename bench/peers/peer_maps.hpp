// SPDX-License-Identifier: BSD-3-Clause
// What the comparisons of our map with those of other projects share: effort, and where maps agree.
#pragma once

#include <fmt/format.h>
#include <malloc.h>

#include <array>
#include <cstdlib>

#include "../bench_arguments.hpp"
#include "../thread_time.hpp"
#include "io/error.hpp"
#include "map/map_fusion.hpp"
#include "recording/recording.hpp"

namespace photonav::peers {

enum class Cell : std::uint8_t { unknown, free, occupied };
constexpr std::array kNames{"unknown", "free", "occupied"};

/// Processor time and memory of an integration.
struct Effort {
    double milliseconds = 0.;  ///< an image, on average, of all threads
    double megabytes = 0.;     ///< on the heap, in the end
};

inline double heapMegabytes() {
    const auto heap = mallinfo2();
    return static_cast<double>(heap.uordblks + heap.hblkhd) / (1024. * 1024.);
}

/// @param integrate one image into a map
template <typename Integrate>
Effort effortOf(const Recording& recording, const Integrate& integrate) {
    Effort effort;
    const double before = heapMegabytes();
    for (std::size_t i = 0; i < recording.sequence.frames.size(); ++i) {
        const RecordedFrame frame = recording.load(i);
        const double begun = processSeconds();
        integrate(frame);
        effort.milliseconds += 1e3 * (processSeconds() - begun);
    }
    effort.milliseconds /= static_cast<double>(recording.sequence.frames.size());
    effort.megabytes = heapMegabytes() - before;
    return effort;
}

/// The lines above the rows of efforts.
inline void printHeading(const RecordingOptions& options, const Recording& recording,
                         double resolution, const FusionOptions& fusion) {
    const Camera& camera = recording.sequence.camera;
    fmt::print("{}: {} images of {}x{}, cells of {} m, up to {} m\n\n", options.dataset,
               recording.sequence.frames.size(), camera.width, camera.height, resolution,
               fusion.maxRange);
    fmt::print("{:<40}{:>12}{:>10}{:>12}\n", "", "ms an image", "MB", "leaves");
}

inline void printRow(const char* name, const Effort& effort, std::size_t leaves) {
    fmt::print("{:<40}{:>12.2f}{:>10.2f}{:>12}\n", name, effort.milliseconds, effort.megabytes,
               leaves);
}

/// Integrates the recording into our map and prints the row of its effort.
inline void integrateByUs(const Recording& recording, const FusionOptions& options,
                          TexturedOcTree& map) {
    const Effort effort = effortOf(recording, [&](const RecordedFrame& frame) {
        fuse(map, frame.view, recording.sequence.camera, frame.T_c_w, options);
    });
    printRow("ours (grey values and surfaces as well)", effort, map.getNumLeafNodes());
}

template <typename Tree>
Cell cellOf(const Tree& tree, const octomap::OcTreeKey& key) {
    const auto* node = tree.search(key);
    if (!node) return Cell::unknown;
    return tree.isNodeOccupied(*node) ? Cell::occupied : Cell::free;
}

/// Expands a tree, so that leaves become cells, and visits them: work(key, state).
template <typename Tree, typename Work>
void forEachCell(Tree& tree, const Work& work) {
    tree.expand();
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        work(leaf.getKey(), tree.isNodeOccupied(*leaf) ? Cell::occupied : Cell::free);
    }
}

/// How many cells are in each pair of states. Cells that neither map knows are not counted.
struct Agreement {
    std::array<std::array<std::size_t, 3>, 3> counts{};  // [ours][theirs]

    void add(Cell ours, Cell theirs) {
        ++counts[static_cast<std::size_t>(ours)][static_cast<std::size_t>(theirs)];
    }
};

/// @param theirs whose map the other is: "OctoMap's"
inline void print(const Agreement& agreement, const char* theirs) {
    fmt::print("\ncells: ours (rows) against {}\n{:<12}", theirs, "");
    for (const char* name : kNames) fmt::print("{:>12}", name);
    std::size_t known = 0, agreed = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        fmt::print("\n{:<12}", kNames[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t count = agreement.counts[i][k];
            fmt::print("{:>12}", count);
            if (i == 0 || k == 0) continue;
            known += count;
            agreed += i == k ? count : 0;
        }
    }
    fmt::print("\nagree in {:.2f} % of the {} cells that both know\n",
               100. * static_cast<double>(agreed) / static_cast<double>(known), known);
}

/// The main function of a comparison, called as PROGRAM [DATASET [resolution [every]]]. Integrates
/// the recording into our map first.
/// @param compareWith is given the recording, the options of our fusion, and our map
template <typename CompareWith>
int runComparison(int argc, char** argv, const char* program, const CompareWith& compareWith) {
    const std::string usage = fmt::format("{} [RECORDING] [RESOLUTION=0.05] [EVERY=1]", program);
    const BenchArguments arguments(argc, argv, usage);
    RecordingOptions options;
    options.dataset = arguments.text(1, PHOTONAV_SOURCE_DIR "/data/flight_front45");
    const double resolution = arguments.number(2, 0.05, 0.001);
    options.every = arguments.number(3, options.every, 1);
    try {
        const Recording recording = readRecording(options);
        const FusionOptions fusion;
        printHeading(options, recording, resolution, fusion);
        TexturedOcTree ours(resolution);
        integrateByUs(recording, fusion, ours);
        compareWith(recording, fusion, ours);
        return 0;
    } catch (const InputError& error) {
        fmt::print(stderr, "{}: {}\n", program, error.what());
        return 2;
    }
}

}  // namespace photonav::peers
