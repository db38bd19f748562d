// SPDX-License-Identifier: BSD-3-Clause
// Decides when tracking counts as lost, how widely the camera is then searched for, and when the
// loss ends.
#pragma once

#include <optional>

#include "alignment/alignment.hpp"

namespace photonav {

struct LossOptions {
    /// Number of consecutive rejected images after which tracking counts as lost. Without odometry
    /// one is enough, because motion is only extrapolated.
    int rejectedImages = 3;
    double blindTime = 1.5;  ///< time without images after which it counts as lost (odometry) [s]
    // While lost, images are aligned with a wider belief than the tracker's.
    double searchRadius = 0.3;   ///< standard deviation added to each axis of the position [m]
    double searchGrowth = 0.02;  ///< relative growth of searchRadius per rejected image
    double searchTurn = 0.1;     ///< standard deviation added about the vertical [rad]
    /// Factor on TrustOptions::maxUnexplained for an image that ends a loss, because little else
    /// supports its pose.
    double maxUnexplainedShare = 0.5;
    /// Duration of a loss after which odometry is trusted more than a map that is built on the same
    /// flight [s]: TrackedFrame::isMapInconsistent.
    double inconsistentAfter = 3.;
    // With a map but without odometry: limits of the belief's standard deviations after rejected
    // images.
    double maxTranslation = 1.;  ///< [m]
    double maxRotation = 0.5;    ///< [rad]
    /// Number of consecutive rejected images after which keyframes begin anew at the present
    /// belief.
    int freshStartAfter = 20;
    /// Number of rejected images after which the start counts as wrong, if none was tracked yet.
    /// Black images are not counted.
    int wrongStartAfter = 10;
};

/// Whether an alignment ends a loss of tracking: it must reduce the covariance in all directions
/// that the loss has widened. An image of a surface without texture, or of stripes along such a
/// direction, does not end a loss, however well it agrees with the map.
/// @param before covariance of the belief before it was widened, camera frame
/// @param prior widened covariance, the prior of the alignment, camera frame
/// @param after covariance after the alignment, camera frame
bool resolvesLoss(const Matrix6& before, const Matrix6& prior, const Matrix6& after);

/// The state of tracking over time: tracked or lost.
class LossOfTracking {
  public:
    explicit LossOfTracking(const LossOptions& options) : options_(options) {}

    /// Reports an image that was accepted; it ends a loss. All times are in [s].
    void onTracked(double time);
    /// Reports an image that was rejected. With odometry, an image without information that agrees
    /// with the prediction, such as a surface without texture, is accepted instead: planned paths
    /// lead past such surfaces.
    /// @param isMotionMeasured whether there is odometry
    /// @param isBlack whether the image is black (photonav::isBlack())
    void onRejected(double time, bool isMotionMeasured, bool isBlack = false);
    /// Reports an image of a part of the scene that a growing map does not contain yet. It is
    /// neither accepted nor rejected.
    void onUnmapped(double time) { lastImage_ = time; }
    /// Reports the present time, for losses without images (LossOptions::blindTime).
    void onTime(double time);

    bool isLost() const { return since_.has_value(); }
    std::optional<double> since() const { return since_; }  ///< begin of the present loss [s]
    int timesLost() const { return timesLost_; }            ///< number of losses
    double lostTime(double now) const;                      ///< sum of all losses until now [s]

    /// Whether keyframes should begin anew (LossOptions::freshStartAfter).
    bool wantsFreshStart() const { return rejectedInRow_ >= options_.freshStartAfter; }
    /// Whether the start counts as wrong (LossOptions::wrongStartAfter).
    bool isStartWrong() const {
        return !wasTracked_ && rejectedWithContent_ >= options_.wrongStartAfter;
    }

    /// A belief with the wider covariance that the search while lost uses.
    UncertainPose widened(const UncertainPose& T_c_w) const;

    /// Whether the residuals of an alignment are small enough to end a loss, and its texture, where
    /// it is known, is in its place.
    /// @param sigma standard deviation of the image noise [grey value]
    bool isExplained(const Alignment& alignment, const TrustOptions& trust, double sigma) const;

  private:
    void begin(double time);

    LossOptions options_;
    double lastImage_ = 0.;
    int rejectedInRow_ = 0;
    int searched_ = 0;
    int rejectedWithContent_ = 0;  // rejected images that are not black
    bool wasTracked_ = false;
    std::optional<double> since_;
    double lost_ = 0.;
    int timesLost_ = 0;
};

}  // namespace photonav
