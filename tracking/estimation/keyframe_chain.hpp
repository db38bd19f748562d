// SPDX-License-Identifier: BSD-3-Clause
// Earlier images with depth as what an image is aligned to: visual odometry.
#pragma once

#include <deque>
#include <optional>

#include "alignment/keyframe_model.hpp"
#include "estimation/tracked_frame.hpp"

namespace photonav {

struct KeyframeChainOptions {
    KeyframeOptions keyframe;
    // A tracked image becomes the next keyframe when one of these is exceeded.
    double minOverlap = 0.8;     ///< share of the keyframe's points in view
    double maxShift = 0.12;      ///< distance from the keyframe [mean depths]
    double maxTurn = 0.2;        ///< angle from the keyframe [rad]
    std::size_t keyframes = 12;  ///< remembered: a lost camera may come back to any of them
};

/// Keyframes, each with the belief of its pose. The belief of an image is that of its keyframe
/// compounded with the alignment: each keyframe adds its own error, none is ever taken back, since
/// no loops are closed.
class KeyframeChain {
  public:
    KeyframeChain(const Camera& camera, const KeyframeChainOptions& options)
        : camera_(camera), options_(options) {}

    bool isEmpty() const { return keyframes_.empty(); }
    const KeyframeChainOptions& options() const { return options_; }
    double latestTime() const { return keyframes_.back().time; }

    /// Makes a keyframe of an image. One that cannot even be aligned to itself is none.
    bool begin(const View& view, const UncertainPose& T_k_w, double time);

    /// Alignment to the latest keyframe.
    /// @param prior covariance relative to the keyframe
    Alignment align(const ImageF& image, const UncertainPose& prior) {
        return keyframes_.back().model.align(image, prior);
    }
    /// The same after the last image tracked became the latest keyframe; nothing when it is one.
    std::optional<Alignment> alignToLastTracked(const ImageF& image, const UncertainPose& prior);
    /// Alignment to the newest of the remembered keyframes that explains the image without a prior;
    /// it is the latest afterwards.
    /// @param maxUnexplained share of the variance, see TrustOptions
    std::optional<Alignment> relocalize(const ImageF& image, double maxUnexplained);

    /// Belief of an image aligned to the latest keyframe.
    UncertainPose beliefOf(const Alignment& alignment) const;

    /// An image was tracked: it becomes a keyframe if the latest one is too far.
    /// @param overlap share of the latest keyframe's points in view
    /// @param meanDepth of the view [m]
    void add(const View& view, const UncertainPose& T_c_w, double time, double overlap,
             double meanDepth);
    /// An image was lost: the one before is no longer near.
    void forgetLastTracked() { lastTracked_.reset(); }

  private:
    struct Keyframe {
        KeyframeModel model;
        UncertainPose T_k_w;
        double time;
    };
    struct TrackedView {
        View view;
        UncertainPose T_c_w;
        double time;
    };

    Keyframe keyframeOf(const View& view, const UncertainPose& T_k_w, double time) const;
    void remember(Keyframe keyframe);
    bool isFar(const Pose& T_c_w, double overlap, double meanDepth) const;

    Camera camera_;
    KeyframeChainOptions options_;
    std::deque<Keyframe> keyframes_;          ///< the one in use is the last
    std::optional<TrackedView> lastTracked_;  ///< unless it is a keyframe
};

}  // namespace photonav
