// SPDX-License-Identifier: BSD-3-Clause
#include "control/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace photonav {
namespace {

constexpr double kSettleTime = 1.5;        // at the goal [s]
constexpr double kPhotometricTime = 10.;   // at most, for the goal's image [s]
constexpr double kPhotometricStep = 0.01;  // below which, or twice the noise, it is reached
                                           // [m, rad]
constexpr int kPhotometricImages = 6;      // in a row

/// An image in the exposure of the model.
ImageF asModelled(const ImageF& observed, const Exposure& exposure) {
    ImageF image = observed;
    for (unsigned i = 0; i < image.getSize(); ++i) {
        image.bitmap[i] = static_cast<float>((image.bitmap[i] - exposure.offset) / exposure.gain);
    }
    return image;
}

}  // namespace

Pilot::Pilot(std::vector<PlannedView> plan, std::shared_ptr<const ViewSource> map,
             const Camera& camera, const Pose& T_b_c, const PilotOptions& options)
    : map_(std::move(map)),
      T_b_c_(T_b_c),
      options_(options),
      route_(std::move(plan), T_b_c, options.route),
      servo_(T_b_c, options.servo),
      goalServo_(*map_, camera, T_b_c, route_.goal().T_w_b, {.photometric = options.photometric}) {}

void Pilot::observe(const Tracker& tracker, const TrackedFrame& tracked, const ImageF& image) {
    if (tracker.loss().isLost()) return leaveImage();
    if (!atGoalSince_) return;
    const Pose T_w_b = tracked.T_c_w.mean.inverse() * T_b_c_.inverse();
    approachOnImage(tracked.lost ? image : asModelled(image, tracked.alignment.exposure), T_w_b);
}

/// The belief is all there is.
void Pilot::leaveImage() {
    onImage_.reset();
    smallSteps_ = 0;
}

void Pilot::approachOnImage(const ImageF& image, const Pose& T_w_b) {
    if (!options_.photometricGoal || !goalServo_.isInformative()) return;
    const PhotometricServo::Step step = goalServo_.toward(image, T_w_b);
    if (!step.isTrusted) return leaveImage();
    hasServoedOnImage_ = true;
    onImage_ = step.velocity;
    const double small = std::max(kPhotometricStep, 2. * goalServo_.sigma());
    const bool isSmall =
        step.displacement.linear.norm() < small && std::abs(step.displacement.yawRate) < small;
    smallSteps_ = isSmall ? smallSteps_ + 1 : 0;
}

BodyVelocity Pilot::command(const Tracker& tracker, double time, double dt) {
    command_ = limited(decide(tracker, time), command_, options_.servo, dt);
    return command_;
}

BodyVelocity Pilot::decide(const Tracker& tracker, double time) {
    const UncertainPose belief = tracker.belief();
    if (const auto lostSince = tracker.loss().since()) {
        if (time - *lostSince < options_.hoverTime) return {};
        const Pose& T_certain_w = tracker.lastCertainView();
        if (isNear(belief.mean, T_certain_w)) return servo_.toward(belief.mean, T_certain_w);
    }
    if (atGoalSince_) {
        return onImage_ ? *onImage_ : servo_.toward(belief.mean, route_.cameraAt(route_.goal()));
    }
    const PlannedView& target = route_.advance(belief);
    if (route_.isAtGoal()) atGoalSince_ = time;
    return servo_.toward(belief.mean, route_.cameraAt(target));
}

bool Pilot::isNear(const Pose& T_c_w, const Pose& T_other_w) const {
    const Eigen::Vector3d apart_w =
        T_c_w.inverse().translation() - T_other_w.inverse().translation();
    return apart_w.norm() < options_.returnDistance;
}

bool Pilot::hasArrived(const Tracker& tracker, double time) const {
    if (!atGoalSince_ || tracker.loss().isLost()) return false;
    const double waited = time - *atGoalSince_;
    return onImage_ ? smallSteps_ >= kPhotometricImages || waited > kPhotometricTime
                    : waited > kSettleTime;
}

bool Pilot::hasGivenUp(const Tracker& tracker, double time) const {
    const auto since = tracker.loss().since();
    return since && time - *since > options_.hoverTime + options_.giveUpTime;
}

}  // namespace photonav
