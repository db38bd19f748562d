// SPDX-License-Identifier: BSD-3-Clause
#include "runs/replay_source.hpp"

#include <algorithm>
#include <utility>

#include "io/error.hpp"

namespace photonav {

bool ReplaySource::hasGroundtruth() const {
    return std::any_of(frames.begin(), frames.end(), [](const Frame& f) { return f.T_c_w; });
}

ReplaySource openReplaySource(const RecordingOptions& options) {
    RecordingOptions forgiving = options;
    forgiving.forgiving = true;
    Recording recording = readRecording(forgiving);
    ReplaySource source;
    source.layout = recording.layout;
    source.stereo = recording.stereo;
    source.note = recording.note;
    source.camera = recording.sequence.camera;
    source.cameraFile = recording.sequence.cameraFile;
    source.informationScale = recording.sequence.informationScale;
    source.skipped = recording.sequence.skipped;
    source.recorded = recording.sequence.recorded;
    for (const auto& entry : recording.sequence.frames) {
        source.frames.push_back({entry.timestamp, {}, entry.colourFile});
        if (entry.hasPose) source.frames.back().T_c_w = entry.T_c_w;
    }
    source.load = std::move(recording.view);
    if (options.up != "z" && !source.hasGroundtruth()) {
        throw InputError("--up", "", "the recording has no true poses to turn");
    }
    return source;
}

}  // namespace photonav
