// SPDX-License-Identifier: BSD-3-Clause
#include "control/route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "geometry/se3.hpp"
#include "geometry/segment.hpp"

namespace photonav {
namespace {

constexpr double kCatchUp = 2.;    // of the phase, toward the body's own [1/s]
constexpr double kApproach = 1.5;  // of where it may have to stop: rate by the phase left [1/s]
constexpr double kLook = 0.05;     // of phase between the places ahead that are looked at [s]

Station stationOf(const Pose& T_w_b) {
    Station station;
    station << T_w_b.translation(), yawOf(T_w_b);
    return station;
}

Pose poseOf(const Station& station) { return levelPose(station.head<3>(), station[3]); }

SmoothPath pathOf(const std::vector<PlannedView>& plan, const RouteOptions& options) {
    if (plan.size() < 2) throw std::invalid_argument("flight: a plan has at least two views");
    std::vector<Station> corners;
    corners.reserve(plan.size());
    for (const PlannedView& view : plan) corners.push_back(stationOf(view.T_w_b));
    MotionLimits limits = options.limits;
    limits.maxAcceleration *= options.accelerationShare;
    limits.maxYawAcceleration *= options.accelerationShare;
    return {std::move(corners), limits, options.tolerance};
}

}  // namespace

Route::Route(std::vector<PlannedView> plan, const Pose& T_b_c, const RouteOptions& options,
             const BodyVelocity& velocity)
    : plan_(std::move(plan)), T_b_c_(T_b_c), options_(options), path_(pathOf(plan_, options)) {
    const Station slope = path_.at(0.).first;
    const double atFullRate = along(slope, slope);
    if (atFullRate <= 0.) return;
    Station now;
    now.head<3>() = plan_.front().T_w_b.linear() * velocity.linear;
    now[3] = velocity.yawRate;
    rate_ = std::clamp(along(slope, now) / atFullRate, 0., path_.rateLimit(0.));
}

/// Scalar product of a derivative of the path with an offset, both as shares of the limits: the
/// phase that the offset is worth where the path is flown at a limit [s].
double Route::along(const Station& slope, const Station& offset) const {
    const double speed = options_.limits.maxSpeed, yawRate = options_.limits.maxYawRate;
    return slope.head<3>().dot(offset.head<3>()) / (speed * speed) +
           slope[3] * offset[3] / (yawRate * yawRate);
}

double Route::tolerance(const UncertainPose& belief) const {
    const double sigma = std::sqrt(belief.covariance.topLeftCorner<3, 3>().trace());
    const double least = options_.tolerance.position;
    return std::clamp(options_.toleranceSigmas * sigma, least,
                      std::max(least, options_.maxTolerance));
}

/// @param offset of the belief from the path
double Route::allowedRate(const UncertainPose& belief, const Station& offset) const {
    const double tolerances = std::max(offset.head<3>().norm() / tolerance(belief),
                                       std::abs(offset[3]) / options_.tolerance.yaw);
    return std::clamp(2. - tolerances, 0., 1.);
}

Route::Reference Route::advance(const UncertainPose& belief, double dt, const IsFree& isFree) {
    const Pose T_w_b = (T_b_c_ * belief.mean).inverse();
    const auto offsetFrom = [&](const Station& station) {
        Station offset = stationOf(T_w_b) - station;
        offset[3] = std::remainder(offset[3], 2. * std::numbers::pi);
        return offset;
    };
    const SmoothPath::Point before = path_.at(phase_);
    const Station offset = offsetFrom(before.station);
    const double ahead = along(before.first, offset);
    const double allowed = allowedRate(belief, offset - ahead * before.first);
    const double growth = path_.rateGrowth(phase_, rate_);
    double most = std::min(allowed, approachRate(belief));
    if (isFree) most = std::min(most, freeRate(offset.head<3>(), isFree));
    rate_ = std::min({rate_ + growth * dt, most, path_.rateLimit(phase_)});
    phase_ = std::clamp(phase_ + (rate_ + allowed * kCatchUp * ahead) * dt, 0., path_.end());

    const SmoothPath::Point here = path_.at(phase_);
    const double left = (path_.end() - phase_) * options_.limits.maxSpeed;
    atGoal_ = left < options_.tolerance.position &&
              allowedRate(belief, offsetFrom(path_.at(path_.end()).station)) >= 1.;
    passViews(belief);
    const double responded = phase_ + rate_ * options_.responseTime;
    const double rate = std::min({rate_ + growth * options_.responseTime, most,
                                  responded < path_.end() ? path_.rateLimit(responded) : 0.});
    const SmoothPath::Point later = path_.at(responded);
    return {poseOf(here.station),
            {T_w_b.linear().transpose() * (rate * later.first.head<3>()), rate * later.first[3]}};
}

bool Route::needs(const PlannedView& view, const UncertainPose& belief) const {
    const double sigma = widestSigma(belief.covariance);
    return sigma > options_.maxTolerance && std::sqrt(2.) * widestSigma(view.covariance) < sigma;
}

double Route::approachRate(const UncertainPose& belief) const {
    for (std::size_t i = next_; i < plan_.size(); ++i) {
        const double left = path_.phaseOf(i) - phase_;
        if (kApproach * left > 1.) break;
        if (plan_[i].isWaypoint && needs(plan_[i], belief)) return std::max(0., kApproach * left);
    }
    return 1.;
}

/// @param offset_w of the belief from the path, kept on the way ahead
double Route::freeRate(const Eigen::Vector3d& offset_w, const IsFree& isFree) const {
    double left = 0.;
    while (kApproach * left < 1. && isFree(path_.at(phase_ + left).station.head<3>() + offset_w)) {
        left += kLook;
    }
    return std::clamp(kApproach * (left - kLook), 0., 1.);
}

void Route::passViews(const UncertainPose& belief) {
    const double near = tolerance(belief) / options_.limits.maxSpeed;  // [s]
    for (; next_ + 1 < plan_.size(); ++next_) {
        const PlannedView& view = plan_[next_];
        const double left = path_.phaseOf(next_) - phase_;
        if (left > (view.isWaypoint && needs(view, belief) ? near : 0.)) break;
        if (view.isWaypoint) passed_ = next_;
    }
    if (atGoal_) passed_ = next_;
}

Route Route::rejoined(const Pose& T_w_b) const {
    const Eigen::Vector3d p_w = T_w_b.translation();
    PlannedView nearest = plan_.front();
    std::size_t after = 1;
    for (std::size_t i = 1; i <= next_; ++i) {
        const Eigen::Vector3d from_w = plan_[i - 1].T_w_b.translation();
        const Eigen::Vector3d to_w = plan_[i].T_w_b.translation();
        const double share = nearestOnSegment(p_w, from_w, to_w);
        const Eigen::Vector3d on_w = from_w + share * (to_w - from_w);
        if ((on_w - p_w).norm() > (nearest.T_w_b.translation() - p_w).norm()) continue;
        nearest = plan_[i - 1];
        nearest.isWaypoint = false;
        nearest.T_w_b.translation() = on_w;
        nearest.distance += share * (plan_[i].distance - plan_[i - 1].distance);
        after = i;
    }
    std::vector<PlannedView> plan{nearest, nearest};
    plan.front().T_w_b = T_w_b;
    plan.insert(plan.end(), plan_.begin() + static_cast<std::ptrdiff_t>(after), plan_.end());
    return {std::move(plan), T_b_c_, options_};
}

double Route::distance() const {
    const SmoothPath::OnLeg place = path_.legAt(phase_);
    const double from = plan_[place.from].distance;
    return place.share > 0. ? from + place.share * (plan_[place.from + 1].distance - from) : from;
}

}  // namespace photonav
