// SPDX-License-Identifier: BSD-3-Clause
#include "recording/stereo_recording.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "dataset/sequence_euroc.hpp"
#include "depth/stereo_depth.hpp"
#include "io/error.hpp"

namespace photonav {
namespace {

/// Options for values that EuRoC recordings have themselves or lack are errors.
void checkForStereo(const RecordingOptions& options) {
    if (!options.cameraFile.empty()) {
        throw InputError("--camera", "", "EuRoC recordings contain their camera parameters");
    }
    if (options.depthScale) {
        throw InputError("--depth-scale", "", "EuRoC recordings have no depth images");
    }
    if (options.up ==
        "floor") {  // depth from stereo is too rough to separate a floor from a mat on it
        throw InputError("--up", "floor", "is sought in depth images, which EuRoC recordings lack");
    }
}

std::shared_ptr<StereoDepth> stereoOf(const StereoSequence& sequence, const std::string& method) {
    StereoOptions options;
    if (method == "sgbm") options.method = StereoMethod::semiGlobal;
    try {
        return std::make_shared<StereoDepth>(sequence.left, sequence.right, options);
    } catch (const std::invalid_argument& error) {
        throw InputError(sequence.right.file, "T_BS", error.what());
    }
}

/// Whose poses they are.
std::string noteOn(const StereoSequence& sequence) {
    const std::string note = "poses are those of the left camera, rectified";
    const std::string& of = sequence.groundtruthOf;
    if (of.empty()) return note;
    return note + "; recorded were the poses of the " + (of == "cam0" ? "left camera" : of);
}

}  // namespace

Recording readStereoRecording(const RecordingOptions& options) {
    checkForStereo(options);
    EurocOptions euroc;
    euroc.tolerance = options.tolerance;
    const auto images = std::make_shared<StereoSequence>(readEurocSequence(options.dataset, euroc));
    Recording recording;
    recording.layout = "EuRoC";
    recording.hasImageFiles = false;  // they are rectified
    recording.stereo = options.stereo.empty() ? "bm" : options.stereo;
    recording.note = noteOn(*images);
    const auto stereo = stereoOf(*images, recording.stereo);
    Sequence& sequence = recording.sequence;
    sequence.camera = stereo->camera();
    sequence.skipped = images->skipped;
    sequence.recorded = images->recorded;
    for (const auto& [timestamp, T_c_w, hasPose, leftFile, rightFile] : images->frames) {
        const Pose T_r_w = hasPose ? stereo->T_r_c() * T_c_w : Pose::Identity();
        sequence.frames.push_back({timestamp, T_r_w, hasPose, leftFile, {}});
    }
    recording.view = [images, stereo](std::size_t i) {
        View view;
        (*stereo)(loadStereo(*images, i), view);
        return view;
    };
    return recording;
}

}  // namespace photonav
