// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/loss_of_tracking.hpp"

#include "geometry/loewner_order.hpp"

namespace photonav {
namespace {

/// Share of the variance added by a loss that may be left when it ends.
constexpr double kLeft = 0.5;
/// Share of the prior's variance that an image must leave in one direction at most, to inform.
constexpr double kInformed = 0.5;

/// So that directions that are known exactly are comparable [m^2 or rad^2].
constexpr double kSlack = 1e-18;

}  // namespace

bool resolvesLoss(const Matrix6& before, const Matrix6& prior, const Matrix6& after) {
    const Matrix6 slack = kSlack * Matrix6::Identity();
    const Matrix6 allowed = 2. * before + kLeft * (prior - before);
    const bool hasInformed = !isLoewnerLess(kInformed * (prior + slack), after);
    return hasInformed && isLoewnerLess(after, allowed + slack);
}

void LossOfTracking::onTracked(double time) {
    lastImage_ = time;
    rejectedInRow_ = 0;
    searched_ = 0;
    wasTracked_ = true;
    if (since_) lost_ += time - *since_;
    since_.reset();
}

void LossOfTracking::onRejected(double time, bool isMotionMeasured, bool isBlack) {
    lastImage_ = time;
    ++rejectedInRow_;
    rejectedWithContent_ += !isBlack;
    if (since_) ++searched_;
    if (!isMotionMeasured || rejectedInRow_ >= options_.rejectedImages) begin(time);
}

void LossOfTracking::onTime(double time) {
    if (time - lastImage_ > options_.blindTime) begin(time);
}

void LossOfTracking::begin(double time) {
    if (since_) return;
    since_ = time;
    ++timesLost_;
}

double LossOfTracking::lostTime(double now) const { return lost_ + (since_ ? now - *since_ : 0.); }

UncertainPose LossOfTracking::widened(const UncertainPose& T_c_w) const {
    UncertainPose wide = T_c_w;
    const double radius = options_.searchRadius * (1. + options_.searchGrowth * searched_);
    wide.covariance.diagonal().head<3>().array() += radius * radius;
    const Eigen::Vector3d up_c = wide.mean.linear().col(2);
    wide.covariance.bottomRightCorner<3, 3>() +=
        options_.searchTurn * options_.searchTurn * up_c * up_c.transpose();
    return wide;
}

bool LossOfTracking::isExplained(const Alignment& alignment, const TrustOptions& trust,
                                 double sigma) const {
    const ResidualStatistics& residual = alignment.residual;
    if (residual.texture && !residual.texture->isAbove(trust.minTexture)) return false;
    return residual.rms <= trust.residualSigmas * sigma ||
           residual.unexplainedCoarse() <= options_.maxUnexplainedShare * trust.maxUnexplained;
}

}  // namespace photonav
