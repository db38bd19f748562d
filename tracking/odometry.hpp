// SPDX-License-Identifier: BSD-3-Clause
// Visual odometry: where the camera is, relative to where it began, from images with depth alone.
#pragma once

#include <deque>
#include <optional>

#include "keyframe_model.hpp"
#include "motion_model.hpp"

namespace photonav {

struct OdometryOptions {
    KeyframeOptions keyframe;
    MotionNoise motion;
    // A tracked image becomes the next keyframe when one of these says so.
    double minOverlap = 0.8;     ///< share of the keyframe's points in view
    double maxShift = 0.12;      ///< distance from the keyframe [mean depths]
    double maxTurn = 0.2;        ///< angle from the keyframe [rad]
    double sureness = 0.5;       ///< share of maxUnexplained that a remembered keyframe may leave
    std::size_t keyframes = 12;  ///< remembered: a lost camera may come back to any of them
    int patience = 20;           ///< images lost one after the other before a new beginning
};

/// Aligns every image to the latest keyframe, with the motion so far as prior. When that fails it
/// looks for the camera in turn: where it was last, relative to the image tracked last, and at each
/// remembered keyframe, where it must be found beyond doubt, because nothing but the image speaks
/// for it; else the image is lost, and the belief goes on growing. When nothing is found for long,
/// the image becomes a keyframe where the belief is then: what follows is as uncertain as that.
///
/// Beliefs are those of the keyframes compounded with the alignment to them. Each keyframe adds its
/// own error, none is ever taken back: there is no closing of loops.
class Odometry {
  public:
    Odometry(const Camera& camera, const UncertainPose& start, const OdometryOptions& options = {});

    /// The next image. The first one that shows anything becomes the first keyframe: at the start,
    /// and, when there were images before it, as uncertain as the camera may have moved since.
    /// @param view of the camera's size; depth 0: not measured @throws std::invalid_argument
    /// @param timestamp [s] larger than the one before
    TrackedFrame track(const View& view, double timestamp);

    const UncertainPose& belief() const { return belief_; }

  private:
    struct Keyframe {
        KeyframeModel model;
        UncertainPose T_k_w;
        double timestamp;
    };
    struct TrackedView {
        View view;
        UncertainPose T_c_w;
        double timestamp;
    };

    void take(const View& view, const Alignment& alignment, double timestamp, double elapsed);
    void miss(const View& view, double timestamp, const UncertainPose& motion);
    bool beginWith(const View& view, double timestamp);
    Keyframe keyframeOf(const View& view, const UncertainPose& T_k_w, double timestamp) const;
    void remember(Keyframe keyframe);
    Alignment search(const View& view, const UncertainPose& predicted);
    bool needsKeyframe(const Alignment& alignment) const;

    Camera camera_;
    OdometryOptions options_;
    MotionModel motion_;
    UncertainPose belief_;  ///< of the camera at the last image
    std::optional<double> lastTime_;
    std::deque<Keyframe> keyframes_;          ///< the one in use is the last
    std::optional<TrackedView> lastTracked_;  ///< unless it is a keyframe
    Matrix6 sinceTracked_ = Matrix6::Zero();  ///< covariance of the motion since then
    int imagesLost_ = 0;                      ///< in a row
};

}  // namespace photonav
