// SPDX-License-Identifier: BSD-3-Clause
// The tracking results of all frames of a recording.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/interrupted.hpp"
#include "recording/recording.hpp"
#include "replay/replay_tracker.hpp"

namespace photonav {

enum class FrameStatus {
    tracked,
    lost,
    unreadable,  ///< an image is missing or damaged
};

struct ReplayedFrame {
    std::size_t index = 0;  ///< index in Recording::sequence
    double timestamp = 0.;  ///< [s]
    FrameStatus status = FrameStatus::unreadable;
    TrackedFrame tracked;           ///< default values if the frame is unreadable
    std::optional<Pose> truth_c_w;  ///< true T_c_w
    double seconds = 0.;            ///< wall-clock time of halving and tracking the image [s]
    double density = 0.;            ///< share of the pixels with depth, before halving
    bool isBlack = false;           ///< the image is black
    std::string message;            ///< verdict on the alignment, or why the frame is unreadable
};

/// The observed view of a frame, and the view that the model predicts at the estimated pose with
/// the estimated exposure, reduced in size for figures.
struct ReplayStrip {
    std::size_t frame = 0;  ///< index into ReplayRun::frames
    std::string caption;
    View observed, predicted;
    bool isSample = false;  ///< one of about five samples, or the first lost frame
};

struct ReplayRun {
    bool odometry = false;  ///< tracked without a map
    double scale = 1.;      ///< factor on the information of the alignments
    int halvings = 0;       ///< see ReplayTracker
    double blur = 0.;       ///< see ReplayTracker [pixels]
    std::vector<ReplayedFrame> frames;
    Matrix6 truthCovariance = Matrix6::Zero();  ///< of every true pose, camera frame
    std::vector<ReplayStrip> strips;            ///< about forty frames, evenly spread
    std::optional<std::size_t> alignedFrame;    ///< index of the frame at which alignToTruth() made
                                                ///< the estimate equal to the ground truth
    std::string stopped;  ///< why tracking gave up before the last frame; empty if it did not
    bool interrupted = false;
    double loadSeconds = 0.;   ///< wall-clock time of loading images and of stereo matching [s]
    double trackSeconds = 0.;  ///< wall-clock time of halving and tracking images [s]
};

/// Tracks a recording, image by image. Frames whose images cannot be used are skipped.
/// @param isStopped asked before every frame and between the steps of a frame
/// @param progress called after every frame with the number of frames done
/// @throws InputError if none of the first ten frames can be loaded, with the reason for the first
ReplayRun replay(const Recording& recording, const ReplayTracker& tracker,
                 const IsStopped& isStopped, const std::function<void(std::size_t)>& progress);

/// The frame with this time stamp. The run must contain it.
const ReplayedFrame& frameAt(const ReplayRun& run, double timestamp);

/// The first readable frame; the end iterator if there is none.
std::vector<ReplayedFrame>::const_iterator firstRead(const ReplayRun& run);

/// Transforms the trajectory of odometry, which is estimated relative to its first pose, into the
/// world: all poses are moved by one rigid motion, so that the estimate equals the ground truth at
/// the first readable frame. If that frame has no true pose, the first tracked frame with a true
/// pose is used. Without ground truth, nothing changes.
void alignToTruth(ReplayRun& run);

}  // namespace photonav
