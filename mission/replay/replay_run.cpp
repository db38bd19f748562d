// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/error.hpp"
#include "io/interrupted.hpp"
#include "io/stopwatch.hpp"
#include "recording/halved_view.hpp"
#include "recording/view_difference.hpp"

namespace photonav {
namespace {

constexpr std::size_t kStrips = 40, kSamples = 5;
constexpr std::size_t kFirstFrames = 10;  // at least one of them must be readable

/// Whether an image is one of `wanted` evenly apart, in the middle of as many equal parts.
bool isOneOf(std::size_t wanted, std::size_t i, std::size_t count) {
    if (count <= wanted) return true;
    for (std::size_t k = 0; k < wanted; ++k) {
        if (i == (2 * k + 1) * count / (2 * wanted)) return true;
    }
    return false;
}

/// Loads a frame or says why it cannot be.
std::optional<View> tryToLoad(const Recording& recording, ReplayedFrame& frame) {
    try {
        return recording.view(frame.index);
    } catch (const InputError& error) {
        frame.message = error.what();
        return {};
    }
}

/// When nothing can be read from the beginning, it is not the images that are wrong.
void checkReadable(const std::vector<ReplayedFrame>& frames, const Recording& recording) {
    if (frames.size() != std::min(kFirstFrames, recording.sequence.frames.size())) return;
    const bool anyRead = std::any_of(frames.begin(), frames.end(), [](const auto& f) {
        return f.status != FrameStatus::unreadable;
    });
    if (!anyRead) recording.view(0);  // throws
}

/// Share of the pixels with depth.
double shareKnown(const ImageF& depth) {
    const auto known = std::count_if(depth.bitmap, depth.bitmap + depth.getSize(),
                                     [](float z) { return z > 0.F; });
    return static_cast<double>(known) / depth.getSize();
}

void track(const ReplayTracker& tracker, View& view, ReplayedFrame& frame, ReplayRun& run) {
    frame.density = shareKnown(view.depth);
    Stopwatch watch;
    halve(view, tracker.halvings);
    frame.isBlack = isBlack(view.intensity);
    frame.tracked = tracker.track(view, frame.timestamp);
    frame.seconds = watch.lap();
    run.trackSeconds += frame.seconds;
    frame.status = frame.tracked.rejected ? FrameStatus::lost : FrameStatus::tracked;
    const Alignment& alignment = frame.tracked.alignment;
    frame.message = frame.tracked.rejected && !isLost(alignment.verdict)
                        ? fmt::format("lost: the view does not determine the pose ({})",
                                      describe(alignment, tracker.trust))
                        : describe(alignment, tracker.trust);
}

/// The frame tracked last beside its prediction; odometry predicts it from an earlier image.
ReplayStrip stripOf(const Recording& recording, const ReplayTracker& tracker, const ReplayRun& run,
                    View observed) {
    const ReplayedFrame& frame = run.frames.back();
    const int halvings = halvingsToShow(tracker.camera.width);
    halve(observed, halvings);
    std::optional<TrackedView> keyframe;
    if (frame.tracked.keyframe) {
        const ReplayedFrame& earlier = frameAt(run, *frame.tracked.keyframe);
        keyframe = {recording.view(earlier.index), earlier.tracked};
        halve(keyframe->view, tracker.halvings + halvings);
    }
    const TrackedView seen{std::move(observed), frame.tracked};
    View predicted = tracker.predict(seen, keyframe);
    expose(predicted.intensity, frame.tracked.alignment.exposure);
    return {frame.index, fmt::format("frame {}: {}", frame.index, frame.message), seen.view,
            std::move(predicted)};
}

struct Counts {
    std::size_t lost = 0;
    std::size_t notFound = 0;  ///< though there was something to be seen
};

/// Loads and tracks the next frame.
/// @throws Interrupted when it is stopped in between, also by the views of a map; the frames
///         so far are whole
void addFrame(const Recording& recording, const ReplayTracker& tracker, const IsStopped& isStopped,
              ReplayRun& run, Counts& counts) {
    throwIfStopped(isStopped);
    const std::vector<Sequence::Entry>& entries = recording.sequence.frames;
    const std::size_t i = run.frames.size();
    ReplayedFrame frame;
    frame.index = i;
    frame.timestamp = entries[i].timestamp;
    if (entries[i].hasPose) frame.truth_c_w = entries[i].T_c_w;
    Stopwatch watch;
    std::optional<View> view = tryToLoad(recording, frame);
    run.loadSeconds += watch.seconds();
    throwIfStopped(isStopped);
    if (view) track(tracker, *view, frame, run);
    run.frames.push_back(frame);
    if (!view) return;
    const bool isFirstLoss = frame.tracked.rejected && counts.lost == 0;
    counts.lost += frame.tracked.rejected;
    counts.notFound += frame.tracked.rejected && !frame.isBlack;
    throwIfStopped(isStopped);
    const bool isSample = isFirstLoss || isOneOf(kSamples, i, entries.size());
    if (isSample || isOneOf(kStrips, i, entries.size())) {
        run.strips.push_back(stripOf(recording, tracker, run, std::move(*view)));
        run.strips.back().isSample = isSample;
    }
}

}  // namespace

ReplayRun replay(const Recording& recording, const ReplayTracker& tracker,
                 const IsStopped& isStopped, const std::function<void(std::size_t)>& progress) {
    ReplayRun run;
    run.odometry = tracker.odometry;
    run.scale = tracker.scale;
    run.halvings = tracker.halvings;
    run.blur = tracker.blur;
    Counts counts;
    while (run.frames.size() < recording.sequence.frames.size()) {
        try {
            addFrame(recording, tracker, isStopped, run, counts);
        } catch (const Interrupted&) {
            run.interrupted = true;
            break;
        }
        checkReadable(run.frames, recording);
        if (progress) progress(run.frames.size());
        if (tracker.hasGivenUp && tracker.hasGivenUp()) {
            run.stopped = fmt::format("none of {} images that show something could be found",
                                      counts.notFound);
            break;
        }
    }
    return run;
}

const ReplayedFrame& frameAt(const ReplayRun& run, double timestamp) {
    return *std::lower_bound(
        run.frames.begin(), run.frames.end(), timestamp,
        [](const ReplayedFrame& frame, double time) { return frame.timestamp < time; });
}

std::vector<ReplayedFrame>::const_iterator firstRead(const ReplayRun& run) {
    return std::find_if(run.frames.begin(), run.frames.end(), [](const ReplayedFrame& frame) {
        return frame.status != FrameStatus::unreadable;
    });
}

void alignToTruth(ReplayRun& run) {
    auto tie = firstRead(run);
    if (tie == run.frames.end()) return;
    if (!tie->truth_c_w) {
        tie = std::find_if(tie, run.frames.cend(), [](const ReplayedFrame& frame) {
            return frame.status == FrameStatus::tracked && frame.truth_c_w;
        });
        if (tie == run.frames.end()) return;
    }
    run.alignedFrame = tie->index;
    const Pose T_estimate_truth = tie->tracked.T_c_w.mean.inverse() * *tie->truth_c_w;
    for (ReplayedFrame& frame : run.frames) {
        frame.tracked.T_c_w.mean = frame.tracked.T_c_w.mean * T_estimate_truth;
    }
}

}  // namespace photonav
