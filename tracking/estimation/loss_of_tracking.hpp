// SPDX-License-Identifier: BSD-3-Clause
// When tracking counts as lost, how far the camera is then searched for, and what ends a loss.
#pragma once

#include <optional>

#include "alignment/alignment.hpp"

namespace photonav {

struct LossOptions {
    /// Rejected images in a row before tracking counts as lost. Without odometry one is enough:
    /// motion is then only extrapolated.
    int rejectedImages = 3;
    double blindTime = 1.5;  ///< without any image before it counts as lost, with odometry [s]
    /// While lost, images are aligned with a wider belief than the tracker's.
    double searchRadius = 0.3;   ///< standard deviation added to each axis of the position [m]
    double searchGrowth = 0.02;  ///< its growth with every rejected image, a share of searchRadius
    double searchTurn = 0.1;     ///< standard deviation added about the vertical [rad]
    /// Share of TrustOptions::maxUnexplained that an image may leave unexplained to end a loss:
    /// little else supports its pose.
    double maxUnexplainedShare = 0.5;
    /// After as long a loss, odometry is believed more than a map that is made on the flight: the
    /// map in view is doubted [s].
    double doubtAfter = 3.;
    /// Without odometry, standard deviations at which a lost belief stops growing [m], [rad].
    double maxTranslation = 1.;
    double maxRotation = 0.5;
    /// Rejected images in a row before keyframes begin anew where the camera is believed to be.
    int freshStartAfter = 20;
    /// Images that show something, but are rejected before any was tracked: after as many the start
    /// counts as wrong.
    int wrongStartAfter = 10;
};

/// Whether an alignment leaves no direction wide that the loss has widened. An image of a surface
/// without texture, or of stripes that run along that direction, does not end a loss, however well
/// it agrees with the map.
/// @param before covariance of the belief without the widening
/// @param prior covariance aligned with, widened
/// @param after of the alignment, all three in the camera frame
bool resolvesLoss(const Matrix6& before, const Matrix6& prior, const Matrix6& after);

/// The state of tracking over time.
class LossOfTracking {
  public:
    explicit LossOfTracking(const LossOptions& options) : options_(options) {}

    /// An image agreed with what it was aligned to, and, while lost, resolved the loss.
    void onTracked(double time);
    /// An image was rejected. One that does not inform but agrees, as over a surface without
    /// texture, is not: plans lead there by design.
    /// @param isMotionMeasured by odometry; @param isBlack the image shows nothing
    void onRejected(double time, bool isMotionMeasured, bool isBlack = false);
    /// An image arrived of what a growing map does not show yet: no reason to doubt the pose.
    void onUnmapped(double time) { lastImage_ = time; }
    /// No further image has arrived until now.
    void onTime(double time);

    bool isLost() const { return since_.has_value(); }
    std::optional<double> since() const { return since_; }  ///< [s]
    int timesLost() const { return timesLost_; }
    double lostTime(double now) const;  ///< sum until now [s]

    /// Whether waiting for earlier keyframes to be seen again has been in vain for long.
    bool wantsFreshStart() const { return rejectedInRow_ >= options_.freshStartAfter; }
    /// Whether nothing agrees with the pose at which tracking began.
    bool isStartWrong() const { return !wasTracked_ && inVain_ >= options_.wrongStartAfter; }

    /// The belief as uncertain as it is searched with; wider from image to image.
    UncertainPose widened(const UncertainPose& T_c_w) const;

    /// Whether an image explains enough to end a loss.
    bool isExplained(const Alignment& alignment, const TrustOptions& trust, double sigma) const;

  private:
    void begin(double time);

    LossOptions options_;
    double lastImage_ = 0.;
    int rejectedInRow_ = 0;
    int searched_ = 0;
    int inVain_ = 0;  // rejected images that show something
    bool wasTracked_ = false;
    std::optional<double> since_;
    double lost_ = 0.;
    int timesLost_ = 0;
};

}  // namespace photonav
