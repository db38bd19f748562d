// SPDX-License-Identifier: BSD-3-Clause
#include "replay_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "error.hpp"
#include "sequence_euroc.hpp"
#include "sequence_tum.hpp"
#include "stereo_depth.hpp"
#include "trajectory.hpp"

namespace photonav {
namespace {

ReplaySource openTum(const ReplaySourceOptions& options) {
    if (!options.stereo.empty()) {
        throw InputError("--stereo", "", "is for EuRoC recordings: this one has depth images");
    }
    const RecordingOptions& asked = options;
    RecordingOptions forgiving = asked;
    forgiving.forgiving = true;
    const auto recording = std::make_shared<Recording>(readRecording(forgiving));
    const Sequence& sequence = recording->sequence;
    ReplaySource source;
    source.layout = "TUM RGB-D";
    if (sequence.cameraAssumed) source.note = "the benchmark's Kinect was assumed";
    source.camera = sequence.camera;
    source.cameraFile = sequence.cameraFile;
    source.informationScale = sequence.informationScale;
    source.skipped = sequence.skipped;
    source.recorded = sequence.recorded;
    for (const auto& entry : sequence.frames) {
        source.frames.push_back({entry.timestamp, {}, entry.colourFile});
        if (entry.hasPose) source.frames.back().T_c_w = entry.T_c_w;
    }
    source.load = [recording](std::size_t i) { return loadFrame(recording->sequence, i).view; };
    return source;
}

/// What EuRoC recordings say themselves or do not have is an error. @return up
Eigen::Vector3d checkForEuroc(const ReplaySourceOptions& options) {
    if (!options.cameraFile.empty()) {
        throw InputError("--camera", "", "EuRoC recordings say themselves what their cameras are");
    }
    if (options.depthScale) {
        throw InputError("--depth-scale", "", "EuRoC recordings have no depth images");
    }
    const auto up = parseUp(options.up);
    if (up) return *up;
    throw InputError(
        "--up", "",
        fmt::format("'{}' is not one of {}, nor x,y,z", options.up, fmt::join(axisNames(), ", ")));
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

ReplaySource openEuroc(const ReplaySourceOptions& options) {
    Pose T_recorded_w = Pose::Identity();
    T_recorded_w.linear() = worldUpRotation(checkForEuroc(options)).transpose();
    EurocOptions euroc;
    euroc.tolerance = options.tolerance;
    const auto sequence =
        std::make_shared<StereoSequence>(readEurocSequence(options.dataset, euroc));
    ReplaySource source;
    source.layout = "EuRoC";
    source.stereo = options.stereo.empty() ? "bm" : options.stereo;
    const auto stereo = stereoOf(*sequence, source.stereo);
    source.note = noteOn(*sequence);
    source.camera = stereo->camera();
    source.skipped = sequence->skipped;
    source.recorded = sequence->recorded;
    const auto [first, end] = parseFrames(options.frames, sequence->frames.size());
    std::vector<std::size_t> indices;
    for (std::size_t i = first; i < end; i += std::size_t(options.every)) {
        const auto& entry = sequence->frames[i];
        source.frames.push_back({entry.timestamp, {}, entry.leftFile});
        if (entry.hasPose) {
            source.frames.back().T_c_w = stereo->T_r_c() * entry.T_c_w * T_recorded_w;
        }
        indices.push_back(i);
    }
    source.load = [sequence, stereo, indices](std::size_t i) {
        View view;
        (*stereo)(loadStereo(*sequence, indices.at(i)), view);
        return view;
    };
    return source;
}

}  // namespace

bool ReplaySource::hasGroundtruth() const {
    return std::any_of(frames.begin(), frames.end(), [](const Frame& f) { return f.T_c_w; });
}

ReplaySource openReplaySource(const ReplaySourceOptions& options) {
    if (options.every < 1) throw InputError("--every", "", "must be at least 1");
    if (!(options.tolerance > 0.)) throw InputError("--tolerance", "", "must be above 0");
    if (options.depthScale && !(*options.depthScale > 0.)) {
        throw InputError("--depth-scale", "", "must be above 0");
    }
    if (!options.stereo.empty() && options.stereo != "bm" && options.stereo != "sgbm") {
        throw InputError("--stereo", "",
                         fmt::format("'{}' is not one of bm, sgbm", options.stereo));
    }
    ReplaySource source = isEurocFolder(options.dataset) ? openEuroc(options) : openTum(options);
    if (options.up != "z" && !source.hasGroundtruth()) {
        throw InputError("--up", "", "the recording has no true poses to turn");
    }
    return source;
}

}  // namespace photonav
