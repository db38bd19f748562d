// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight through a tracker, image by image.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "estimation/tracker.hpp"
#include "runs/replay_source.hpp"

namespace photonav {

enum class FrameStatus {
    tracked,
    lost,
    unreadable,  ///< an image is missing or damaged
};

struct ReplayedFrame {
    std::size_t index = 0;  ///< among the frames used
    double timestamp = 0.;  ///< [s]
    FrameStatus status = FrameStatus::unreadable;
    TrackedFrame tracked;  ///< nothing in it when unreadable
    std::optional<Pose> truth_c_w;
    double seconds = 0.;   ///< of tracking, pyramids included
    double density = 0.;   ///< share of the pixels with depth, before halving
    bool isBlack = false;  ///< nothing to be seen in the image
    std::string words;     ///< the alignment's verdict, or why the frame is unreadable
};

/// What was seen and what was predicted where the tracker believes to be, with its exposure.
struct ReplayStrip {
    std::string caption;
    View observed, predicted;
};

struct ReplayRun {
    std::vector<ReplayedFrame> frames;
    std::vector<ReplayStrip> strips;
    std::optional<std::size_t> laidOn;  ///< frame at which layOnTruth() made estimate and truth one
    std::string stopped;                ///< why it ended before the last frame; empty: it did not
    bool interrupted = false;
    double loadSeconds = 0.;   ///< images, and depth from stereo
    double trackSeconds = 0.;  ///< everything else
};

/// A frame as it was given to the tracker, and what it made of it.
struct TrackedView {
    View view;
    TrackedFrame tracked;
};

/// A tracker as a replay sees it.
struct ReplayTracker {
    std::function<TrackedFrame(const View& view, double timestamp)> track;
    /// The view of a frame as the model predicts it at the believed pose; depth 0: nothing there.
    /// @param keyframe that the frame was aligned to, if any
    std::function<View(const TrackedView& frame, const std::optional<TrackedView>& keyframe)>
        predict;
    double scale = 1.;   ///< factor on the information of its alignments
    TrustOptions trust;  ///< of its alignments, to put them in words
    Camera camera;       ///< of the views to be given to it
    int halvings = 0;    ///< of the recorded views
    /// Images lost from the first one on before giving up, not counting black ones; 0: all.
    std::size_t patience = 0;
};

/// Odometry from `start`.
ReplayTracker odometryTracker(const Camera& camera, const UncertainPose& start,
                              const KeyframeChainOptions& options);

/// Localisation in a map, with images halved until they are at most `maxWidth` wide.
ReplayTracker mapTracker(const std::shared_ptr<const ViewSource>& map, const Camera& camera,
                         const UncertainPose& start, const TrackerOptions& options,
                         unsigned maxWidth);

/// Frames whose images cannot be used are passed over.
/// @param progress called after every frame with the number done
/// @throws InputError when none of the first ten frames can be loaded, with the reason of the first
ReplayRun replay(const ReplaySource& source, const ReplayTracker& tracker,
                 const std::atomic<bool>& interrupted,
                 const std::function<void(std::size_t)>& progress);

/// The frame of this timestamp, which is one of them.
const ReplayedFrame& frameAt(const ReplayRun& run, double timestamp);

/// The first frame whose images could be used; the end when there is none.
std::vector<ReplayedFrame>::const_iterator firstRead(const ReplayRun& run);

/// Odometry knows motions only: moves all of its poses so that they begin at the truth, or, where
/// the first image has no true pose, agree with it at the first image tracked that has one.
void layOnTruth(ReplayRun& run);

/// The median of all depths in a few images spread over the recording [m]; 0 when there are none,
/// nothing when none of these images can be used.
std::optional<double> medianDepth(const ReplaySource& source);

}  // namespace photonav
