// SPDX-License-Identifier: BSD-3-Clause
// Visual odometry: images are aligned to a chain of keyframes, which are earlier images with depth.
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
    std::size_t keyframes = 12;  ///< number of keyframes stored, for relocalize()
};

/// Keyframes, each with the belief of its pose. The belief of an image is the belief of its
/// keyframe compounded with the alignment. Each keyframe adds its own error; loops are not closed,
/// so that errors are never corrected.
class KeyframeChain {
  public:
    KeyframeChain(const Camera& camera, const KeyframeChainOptions& options)
        : camera_(camera), options_(options) {}

    bool isEmpty() const { return keyframes_.empty(); }
    const KeyframeChainOptions& options() const { return options_; }
    double latestTime() const { return keyframes_.back().time; }  ///< of the latest keyframe [s]

    /// Makes an image with depth the latest keyframe.
    /// @param T_k_w belief of its pose
    /// @return false, without a new keyframe, if the image cannot be aligned to itself
    bool begin(const View& view, const UncertainPose& T_k_w, double time);

    /// Aligns an image to the latest keyframe.
    /// @param prior prior of T_c_w; its covariance is relative to the keyframe
    Alignment align(const ImageF& image, const UncertainPose& prior) {
        return keyframes_.back().model.align(image, prior);
    }
    /// Makes the image tracked last the latest keyframe.
    /// @return false if that image is a keyframe already, or forgotten
    bool keepLastTracked();
    /// Aligns an image without a prior to the stored keyframes, newest first, until one explains
    /// it. This keyframe becomes the latest one. Returns nothing if none explains the image.
    /// @param maxUnexplained largest share of the variance, see TrustOptions
    std::optional<Alignment> relocalize(const ImageF& image, double maxUnexplained);

    /// Belief T_c_w of an image that was aligned to the latest keyframe.
    UncertainPose beliefOf(const Alignment& alignment) const;

    /// Adds a tracked image: it becomes a keyframe if it is too far from the latest one.
    /// @param overlap share of the latest keyframe's points in view
    /// @param meanDepth of the view [m]
    /// @return whether it became the latest keyframe
    bool add(const View& view, const UncertainPose& T_c_w, double time, double overlap,
             double meanDepth);
    /// Called after a rejected image: the image tracked last does not become a keyframe any more.
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
