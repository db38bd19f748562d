// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/recording_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "evaluation/averages.hpp"
#include "io/error.hpp"
#include "io/interrupted.hpp"
#include "io/stopwatch.hpp"
#include "map/textured_octree.hpp"

namespace photonav {
namespace {

constexpr double kNearest = 0.05;  // of depth from the images, which is sought from there on [m]

void checkOptions(const MapOptions& options) {
    const auto require = [](bool good, const char* option, const std::string& reason) {
        if (!good) throw InputError(option, "", reason);
    };
    const auto positive = [&](double value, const char* option) {
        require(std::isfinite(value) && value > 0., option,
                fmt::format("{} is not a positive number", value));
    };
    positive(options.resolution, "--resolution");
    positive(options.fusion.maxRange, "--max-range");
    require(options.fusion.minRange < options.fusion.maxRange, "--max-range",
            fmt::format("not above the least range, {} m", options.fusion.minRange));
    require(options.depth == "recorded" || options.depth == "monocular", "--depth",
            fmt::format("'{}' is not one of recorded, monocular", options.depth));
    require(options.depth == "recorded" || options.fusion.minRange >= kNearest, "--min-range",
            fmt::format("depth from the images begins at {} m or farther", kNearest));
}

/// Cells are numbered by 16 bits an axis: far from the origin there are none. Nearer than kNear it
/// is the cells that are too small.
void checkPosition(const MapOptions& options, const RecordedFrame& frame) {
    const double farthest = frame.T_c_w.inverse().translation().cwiseAbs().maxCoeff();
    const double reach = kKeyOfZero * options.resolution;
    constexpr double kNear = 100.;
    if (farthest <= std::max(reach, kNear)) return;
    throw InputError(
        (std::filesystem::path(options.dataset) / "groundtruth.txt").string(),
        fmt::format("{:.6f} s", frame.timestamp),
        fmt::format("the camera is {:.6g} m from the origin, a map with cells of {} m ends at {} m",
                    farthest, options.resolution, reach));
}

/// Looks at some pixels of a frame with recorded depth. @returns whether any had one
bool checkDepths(const MapOptions& options, const Sequence& sequence, const View& view) {
    constexpr unsigned kPixels = 100000;
    const auto everyNth = [&](unsigned step) {
        std::vector<float> depths;
        for (unsigned k = 0; k < view.depth.getSize(); k += step) {
            if (view.depth.bitmap[k] > 0.F) depths.push_back(view.depth.bitmap[k]);
        }
        return depths;
    };
    std::vector<float> depths = everyNth(1 + view.depth.getSize() / kPixels);
    if (depths.empty()) depths = everyNth(1);
    if (depths.empty()) return false;
    requirePlausibleDepth(median(std::move(depths), 0.), options, sequence.cameraFile);
    return true;
}

}  // namespace

Recording openForMap(const MapOptions& options) {
    checkOptions(options);
    const RecordingOptions& given = options;
    RecordingOptions reading = given;
    reading.needsDepth = options.depth == "recorded";
    return readRecording(reading);
}

FusedRecording fuseRecording(TexturedOcTree& map, const Recording& recording,
                             const MapOptions& options, const IsStopped& isStopped,
                             const FusionCalls& calls) {
    const Sequence& sequence = recording.sequence;
    FusionOptions fusion = options.fusion;
    fusion.isStopped = isStopped;
    ExposedFusion direct(map, sequence.camera, options.exposure);
    std::optional<MonocularFusion> monocular;
    if (options.depth == "monocular") {
        monocular.emplace(direct, sequence.camera, options.fusion, calls.onReference);
    }
    const auto add = [&](const RecordedFrame& frame) {
        try {
            if (monocular) {
                monocular->add(frame);
            } else {
                direct.add(frame.view, frame.T_c_w, fusion);
            }
        } catch (const std::invalid_argument& error) {  // sizes are checked: cells are too small
            throw InputError("--resolution", "", error.what());
        }
    };
    FusedRecording fused;
    Stopwatch watch;
    bool isDepthChecked = false;
    const auto addNext = [&] {
        throwIfStopped(isStopped);
        const RecordedFrame frame = recording.load(fused.frames);
        fused.loadSeconds += watch.lap();
        throwIfStopped(isStopped);
        checkPosition(options, frame);
        if (!isDepthChecked) isDepthChecked = checkDepths(options, sequence, frame.view);
        if (isBlack(frame.view.intensity)) {
            fused.black.push_back({sequence.frames[fused.frames].colourFile, "black"});
        } else {
            add(frame);
        }
        fused.trajectory.push_back({frame.timestamp, frame.T_c_w.inverse()});
        fused.fuseSeconds += watch.lap();
        ++fused.frames;
        if (calls.progress) calls.progress(fused.frames, sequence.frames.size());
    };
    try {
        while (fused.frames < sequence.frames.size()) addNext();
    } catch (const Interrupted&) {  // the frames so far are in the map
    }
    if (monocular) {
        monocular->finish();
        fused.monocular = monocular->result();
        fused.fuseSeconds += watch.lap();
    }
    return fused;
}

}  // namespace photonav
