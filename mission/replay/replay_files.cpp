// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_files.hpp"

#include <vector>

#include "dataset/colmap_model.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;

json optionsJson(const ReplayOptions& o) {
    return {{"mode", o.odometry ? "odometry" : "map"},
            {"map", o.mapFile},
            {"every", o.every},
            {"frames", o.frames},
            {"up", o.up},
            {"tolerance_s", o.tolerance},
            {"camera", o.cameraFile},
            {"depth_scale", orNull(o.depthScale)},
            {"stereo", o.stereo.empty() ? json(nullptr) : json(o.stereo)},
            {"topics", o.topics},
            {"mount", o.mount},
            {"start", o.start},
            {"start_sigma", orNull(o.startSigma)},
            {"sigma", o.sigma},
            {"scale", *o.scale},
            {"least_sigma", {*o.leastSigma, *o.leastSigmaRotation}},
            {"min_overlap", o.minOverlap},
            {"max_width", o.maxWidth ? json(*o.maxWidth) : json(nullptr)},
            {"exposure", o.exposure},
            {"truth_sigma", {o.truthSigma, o.truthSigmaRotation}}};
}

json datasetJson(const Replay& replay) {
    const Recording& recording = replay.recording();
    return {{"folder", fs::absolute(replay.options().dataset).lexically_normal().string()},
            {"layout", recording.layout},
            {"note", recording.note},
            {"median_depth_m", orNull(replay.medianDepth())},
            {"depth_noise_m", replay.depthNoise()},
            {"depth_error", replay.depthError().relative},
            {"depth_error_assumed", replay.depthError().isAssumed},
            {"camera", cameraJson(recording.sequence.camera)}};
}

void writeColmap(const fs::path& folder, const Replay& replay, const ReplayRun& run) {
    const Recording& recording = replay.recording();
    if (!recording.hasImageFiles) return;
    const fs::path dataset = fs::absolute(replay.options().dataset).lexically_normal();
    std::vector<ColmapImage> images;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status != FrameStatus::tracked) continue;
        const fs::path file = recording.sequence.frames[frame.index].colourFile;
        images.push_back(
            {fs::absolute(file).lexically_relative(dataset).string(), frame.tracked.T_c_w.mean});
    }
    writeColmapModel(folder.string(), recording.sequence.camera, images);
}

}  // namespace photonav
