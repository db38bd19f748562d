// SPDX-License-Identifier: BSD-3-Clause
// The frames of a recording as they were tracked.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "recording/recording.hpp"
#include "replay/replay_tracker.hpp"

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
    TrackedFrame tracked;           ///< nothing in it when unreadable
    std::optional<Pose> truth_c_w;  ///< true T_c_w
    double seconds = 0.;            ///< of tracking, pyramids included
    double density = 0.;            ///< share of the pixels with depth, before halving
    bool isBlack = false;           ///< nothing to be seen in the image
    std::string words;              ///< the alignment's verdict, or why the frame is unreadable
};

/// The observed view of a frame, and the one predicted at the believed pose with its exposure,
/// small enough to be looked at.
struct ReplayStrip {
    std::size_t frame = 0;  ///< index into ReplayRun::frames
    std::string caption;
    View observed, predicted;
    bool isSample = false;  ///< one of the few that stand for all, or the first that was lost
};

struct ReplayRun {
    bool odometry = false;  ///< tracked without a map
    double scale = 1.;      ///< factor on the information of the alignments that was in use
    std::vector<ReplayedFrame> frames;
    std::vector<ReplayStrip> strips;          ///< of at most some forty frames, evenly apart
    std::optional<std::size_t> alignedFrame;  ///< at which alignToTruth() set the estimate
    std::string stopped;  ///< why it ended before the last frame; empty: it did not
    bool interrupted = false;
    double loadSeconds = 0.;   ///< images, and depth from stereo
    double trackSeconds = 0.;  ///< everything else
};

/// Tracks a recording, image by image; frames whose images cannot be used are passed over.
/// @param isStopped asked before every frame
/// @param progress called after every frame with the number done
/// @throws InputError when none of the first ten frames can be loaded, with the reason of the first
ReplayRun replay(const Recording& recording, const ReplayTracker& tracker,
                 const std::function<bool()>& isStopped,
                 const std::function<void(std::size_t)>& progress);

/// The frame of this timestamp, which is one of them.
const ReplayedFrame& frameAt(const ReplayRun& run, double timestamp);

/// The first frame whose images could be used; the end when there is none.
std::vector<ReplayedFrame>::const_iterator firstRead(const ReplayRun& run);

/// Odometry estimates motions only: moves all of its poses so that they begin at the truth, or,
/// where the first image has no true pose, agree with it at the first tracked image that has one.
void alignToTruth(ReplayRun& run);

}  // namespace photonav
