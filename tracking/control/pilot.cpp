// SPDX-License-Identifier: BSD-3-Clause
#include "control/pilot.hpp"

#include <Eigen/Eigenvalues>
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
constexpr double kOtherView = 0.7;         // so far on, other things are in view [m]
constexpr double kBelievedSigmas = 3.;     // within which the body is counted on to be

/// An image in the exposure of the model.
ImageF asModelled(const ImageF& observed, const Exposure& exposure) {
    ImageF image = observed;
    for (unsigned i = 0; i < image.getSize(); ++i) {
        image.bitmap[i] = static_cast<float>((image.bitmap[i] - exposure.offset) / exposure.gain);
    }
    return image;
}

/// Offsets of the body from its mean to places all around on the ellipsoid of kBelievedSigmas [m].
std::vector<Eigen::Vector3d> believedOffsets(const UncertainPose& T_c_w, const Pose& T_b_c) {
    const Matrix6 covariance = inOtherFrame(T_c_w.covariance, T_b_c);  // of T_b_w
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.topLeftCorner<3, 3>());
    const Eigen::Vector3d sigmas = solver.eigenvalues().cwiseMax(0.).cwiseSqrt();
    const Eigen::Matrix3d axes_w = (T_b_c * T_c_w.mean).linear().transpose() *
                                   solver.eigenvectors() * (kBelievedSigmas * sigmas).asDiagonal();
    std::vector<Eigen::Vector3d> offsets_w;
    for (const double x : {-1., 0., 1.}) {
        for (const double y : {-1., 0., 1.}) {
            for (const double z : {-1., 0., 1.}) {
                offsets_w.push_back(axes_w * Eigen::Vector3d(x, y, z).normalized());
            }
        }
    }
    return offsets_w;
}

/// As isLineFree(), in longer steps where nothing is near: lines to all places within a wide belief
/// are long and many.
bool touchesNothingOn(const Eigen::Vector3d& from_w, const Eigen::Vector3d& way_w,
                      const PilotOptions& options) {
    constexpr double kStep = 0.05;  // [m]
    const double length = way_w.norm();
    for (double s = 0.;;) {
        const Eigen::Vector3d p_w = length > 0. ? from_w + s / length * way_w : from_w;
        const double free = options.clearance(p_w) - options.bodyRadius;
        if (free < 0.) return false;
        if (s >= length) return true;
        s = std::min(length, s + std::max(kStep, free - kStep));
    }
}

}  // namespace

Pilot::Pilot(std::vector<PlannedView> plan, std::shared_ptr<const ViewSource> map,
             const Camera& camera, const Pose& T_b_c, const PilotOptions& options)
    : map_(std::move(map)),
      camera_(camera),
      T_b_c_(T_b_c),
      options_(options),
      route_(std::move(plan), T_b_c, options.route),
      servo_(T_b_c, options.servoGain),
      goalServo_(servoToGoal()),
      search_(searchInMap()) {}

std::optional<PhotometricServo> Pilot::servoToGoal() const {
    if (!options_.photometricGoal) return {};  // it renders the view of the goal
    return PhotometricServo(*map_, camera_, T_b_c_, route_.goal().T_w_b,
                            {.photometric = options_.photometric});
}

ViewSearch Pilot::searchInMap() const { return {map_, camera_, T_b_c_, options_.photometric}; }

void Pilot::setPlan(std::vector<PlannedView> plan) {
    followRoute(Route(std::move(plan), T_b_c_, options_.route, command_));
    goalServo_ = servoToGoal();
    hasServoedOnImage_ = false;
}

void Pilot::setMap(std::shared_ptr<const ViewSource> map) {
    map_ = std::move(map);
    goalServo_ = servoToGoal();
    search_ = searchInMap();
    leaveImage();
}

void Pilot::observe(const Tracker& tracker, const TrackedFrame& tracked, const ImageF& image) {
    if (searchSince_) continueSearch(tracker, tracked.time);
    if (tracker.loss().isLost()) return leaveImage();
    if (!atGoalSince_) return;
    const Pose T_w_b = tracked.T_c_w.mean.inverse() * T_b_c_.inverse();
    approachOnImage(tracked.rejected ? image : asModelled(image, tracked.alignment.exposure),
                    T_w_b);
}

/// From now on the pilot approaches the goal by the belief, not by the image.
void Pilot::leaveImage() {
    onImage_.reset();
    smallSteps_ = 0;
}

void Pilot::approachOnImage(const ImageF& image, const Pose& T_w_b) {
    if (!goalServo_ || !goalServo_->isInformative()) return;
    const PhotometricServo::Step step = goalServo_->toward(image, T_w_b);
    if (!step.isTrusted) return leaveImage();
    hasServoedOnImage_ = true;
    onImage_ = step.velocity;
    const double small = std::max(kPhotometricStep, 2. * goalServo_->sigma());
    const bool isSmall =
        step.displacement.linear.norm() < small && std::abs(step.displacement.yawRate) < small;
    smallSteps_ = isSmall ? smallSteps_ + 1 : 0;
}

BodyVelocity Pilot::command(const Tracker& tracker, double time, double dt) {
    // A body that turns keeps its velocity in the world: so long as the command follows it, the
    // limit of acceleration is not used up by turning.
    const Eigen::Matrix3d R_w_b = bodyOf(tracker.belief().mean).linear();
    const BodyVelocity last{R_w_b.transpose() * axes_ * command_.linear, command_.yawRate};
    command_ = limited(decide(tracker, time, dt), last, options_.route.limits, dt);
    axes_ = R_w_b;
    return command_;
}

BodyVelocity Pilot::decide(const Tracker& tracker, double time, double dt) {
    const UncertainPose belief = tracker.belief();
    if (!wayBack_) flown_.moved(bodyOf(belief.mean), bodyOf(tracker.lastCertainView()));
    if (const auto lostSince = tracker.loss().since()) {
        if (time - *lostSince < options_.hoverTime) {
            route_.halt();
            return {};
        }
        if (searched_ && !isSearchSafe(belief)) rejoinPlan(belief);
        if (!searchSince_) beginSearch(tracker, time);
    }
    if (wayBack_) return follow(advance(*wayBack_, tracker, dt), belief);
    if (searched_) {
        route_.halt();
        return servo_.toward(belief.mean, route_.cameraAt(*searched_));
    }
    if (atGoalSince_) {
        return onImage_ ? *onImage_
                        : servo_.toward(belief.mean, route_.cameraAt(route_.goal().T_w_b));
    }
    return alongRoute(tracker, time, dt);
}

BodyVelocity Pilot::alongRoute(const Tracker& tracker, double time, double dt) {
    const UncertainPose belief = tracker.belief();
    const double before = route_.lastWaypoint().distance;
    const Route::Reference reference = advance(route_, tracker, dt);
    const bool isMissed = route_.needs(route_.lastWaypoint(), belief);
    const bool isPassed = route_.lastWaypoint().distance > before;
    if (isPassed && isMissed && !tracker.loss().isLost()) beginSearch(tracker, time);
    if (route_.isAtGoal() && !searchSince_) {
        atGoalSince_ = time;
        hasMissedGoal_ = isMissed;
    }
    return follow(reference, belief);
}

/// A plan has accepted how near to obstacles it leads, with the images that it counts on. While
/// tracking is lost there are none.
Route::Reference Pilot::advance(Route& route, const Tracker& tracker, double dt) const {
    const UncertainPose belief = tracker.belief();
    if (!tracker.loss().isLost() || !options_.clearance) return route.advance(belief, dt);
    return route.advance(belief, dt, untouchedBy(belief));
}

/// Whether the body touches nothing at any place within three standard deviations.
IsFree Pilot::untouchedBy(const UncertainPose& belief) const {
    return [this, offsets_w = believedOffsets(belief, T_b_c_)](const Eigen::Vector3d& p_w) {
        return std::all_of(offsets_w.begin(), offsets_w.end(), [&](const Eigen::Vector3d& offset) {
            return touchesNothingOn(p_w, offset, options_);
        });
    };
}

/// The nearest view beside the plan that narrows the belief, on a way on which the body touches
/// nothing.
std::optional<Pose> Pilot::nearestView(const UncertainPose& belief) const {
    if (!options_.clearance) return {};
    const auto isFree = [&, isUntouched = untouchedBy(belief)](const Eigen::Vector3d& p_w) {
        return options_.clearance(p_w) >= options_.radius && isUntouched(p_w);
    };
    return search_.nearest(belief, route_.lastWaypoint().T_w_b, isFree);
}

/// Whether this is still so of the searched view, with a belief that has become wider.
bool Pilot::isSearchSafe(const UncertainPose& belief) const {
    const Eigen::Vector3d from_w = bodyOf(belief.mean).translation();
    return isLineFree(from_w, searched_->translation(), untouchedBy(belief));
}

BodyVelocity Pilot::follow(const Route::Reference& reference, const UncertainPose& belief) {
    BodyVelocity velocity = servo_.toward(belief.mean, route_.cameraAt(reference.T_w_b));
    velocity.linear += reference.velocity.linear;
    velocity.yawRate += reference.velocity.yawRate;
    return velocity;
}

void Pilot::beginSearch(const Tracker& tracker, double time) {
    searchSince_ = time;
    if (!tracker.loss().isLost()) {
        searched_ = nearestView(tracker.belief());
        if (!searched_) endSearch();
    } else if (isCertainViewNearer(tracker)) {
        route_.halt();
        wayBack_.emplace(flown_.back(), T_b_c_, options_.route);
    }
}

/// An image has arrived.
void Pilot::continueSearch(const Tracker& tracker, double time) {
    if (tracker.loss().isLost()) return;
    const UncertainPose belief = tracker.belief();
    if (wayBack_) return rejoinPlan(belief);
    const bool isTooLong = time - *searchSince_ > options_.giveUpTime;
    if (!searched_ || isTooLong || !route_.needs(route_.lastWaypoint(), belief)) return endSearch();
    const Eigen::Vector3d p_w = bodyOf(belief.mean).translation();
    if ((p_w - searched_->translation()).norm() > options_.route.tolerance.position) return;
    search_.visited(*searched_);
    searched_ = nearestView(belief);
}

void Pilot::rejoinPlan(const UncertainPose& belief) {
    followRoute(route_.rejoined(bodyOf(belief.mean)));
}

/// The goal is to be reached, whatever was before.
void Pilot::followRoute(Route route) {
    route_ = std::move(route);
    endSearch();
    leaveImage();
    atGoalSince_.reset();
    hasMissedGoal_ = false;
}

void Pilot::endSearch() {
    searchSince_.reset();
    searched_.reset();
    wayBack_.reset();
}

/// Whether the last view that determined the pose is nearer than one ahead on the route that should
/// narrow the belief.
bool Pilot::isCertainViewNearer(const Tracker& tracker) const {
    const UncertainPose belief = tracker.loss().widened(tracker.belief());
    const double back = flown_.length();
    for (const PlannedView& view : route_.ahead()) {
        const double way = view.distance - route_.distance();
        if (way < kOtherView) continue;
        if (way > back) break;
        if (search_.narrows(belief, view.T_w_b)) return false;
    }
    return true;
}

bool Pilot::hasArrived(const Tracker& tracker, double time) const {
    if (!atGoalSince_ || hasMissedGoal_ || tracker.loss().isLost()) return false;
    const double waited = time - *atGoalSince_;
    return onImage_ ? smallSteps_ >= kPhotometricImages || waited > kPhotometricTime
                    : waited > kSettleTime;
}

bool Pilot::hasGivenUp(const Tracker& tracker, double time) const {
    const auto since = tracker.loss().since();
    return hasMissedGoal_ || (since && time - *since > options_.hoverTime + options_.giveUpTime);
}

}  // namespace photonav
