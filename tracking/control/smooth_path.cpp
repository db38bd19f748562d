// SPDX-License-Identifier: BSD-3-Clause
#include "control/smooth_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "geometry/constants.hpp"

namespace photonav {
namespace {

constexpr double kControlSpacing = 0.04;  // of control points at the limit of speed [m]
constexpr int kSweeps = 300;              // of the relaxation
constexpr double kOverRelaxation = 1.6;
constexpr double kAtOnce = 1e3;  // growth of a rate at which nothing moves [1/s]

struct Norms {
    double position = 0.;
    double yaw = 0.;
};
Norms normsOf(const Station& s) { return {s.head<3>().norm(), std::abs(s[3])}; }
Norms larger(const Norms& a, const Norms& b) {
    return {std::max(a.position, b.position), std::max(a.yaw, b.yaw)};
}

/// The square of the largest rate with |first| * rate <= speed and |second| * rate^2 <=
/// acceleration.
double squaredRate(double first, double second, double speed, double acceleration) {
    const double bySpeed = first > 0. ? speed / first : kInfinity;
    const double byBend = second > 0. ? acceleration / second : kInfinity;
    return std::min(bySpeed * bySpeed, byBend);
}

/// The square of the largest rate from which braking leads to `next` over a step of phase:
/// |second| * rate^2 + |first| * (rate^2 - next) / (2 * step) <= acceleration.
double brakedFrom(double next, double step, double first, double second, double acceleration) {
    const double weight = first + 2. * step * second;
    return weight > 0. ? (first * next + 2. * step * acceleration) / weight : kInfinity;
}

void check(bool isValid, const char* what) {
    if (!isValid) throw std::invalid_argument(std::string("smooth path: ") + what);
}

}  // namespace

SmoothPath::SmoothPath(std::vector<Station> corners, const MotionLimits& limits,
                       const PathTolerance& tolerance)
    : limits_(limits), corners_(std::move(corners)) {
    check(!corners_.empty(), "no corners");
    check(std::min({limits.maxSpeed, limits.maxYawRate, limits.maxAcceleration,
                    limits.maxYawAcceleration}) > 0.,
          "limits must be positive");
    check(std::min(tolerance.position, tolerance.yaw) > 0., "tolerances must be positive");
    measureLegs();
    const double spacing = kControlSpacing / limits.maxSpeed;
    const auto steps = static_cast<std::size_t>(std::max(1., std::ceil(end() / spacing)));
    step_ = std::max(end(), spacing) / static_cast<double>(steps);
    for (std::size_t i = 0; i <= steps; ++i) {
        controls_.push_back(onLegs(step_ * static_cast<double>(i)));
    }
    relax(tolerance);
    limitRates();
}

/// Unwraps the headings of the corners and adds up their phases.
void SmoothPath::measureLegs() {
    phases_.push_back(0.);
    for (std::size_t i = 1; i < corners_.size(); ++i) {
        const Station& last = corners_[i - 1];
        double& yaw = corners_[i][3];
        yaw = last[3] + std::remainder(yaw - last[3], 2. * std::numbers::pi);
        const Norms leg = normsOf(corners_[i] - last);
        phases_.push_back(phases_.back() +
                          std::max(leg.position / limits_.maxSpeed, leg.yaw / limits_.maxYawRate));
    }
}

SmoothPath::OnLeg SmoothPath::legAt(double phase) const {
    const auto next = std::upper_bound(phases_.begin(), phases_.end(), std::max(phase, 0.));
    if (next == phases_.end()) return {phases_.size() - 1, 0.};
    const auto to = static_cast<std::size_t>(next - phases_.begin());
    return {to - 1, (phase - phases_[to - 1]) / (phases_[to] - phases_[to - 1])};
}

Station SmoothPath::onLegs(double phase) const {
    const OnLeg place = legAt(phase);
    const Station& from = corners_[place.from];
    return place.share > 0. ? Station(from + place.share * (corners_[place.from + 1] - from))
                            : from;
}

/// Beyond its ends the curve goes straight on.
Station SmoothPath::control(std::ptrdiff_t i) const {
    const auto last = static_cast<std::ptrdiff_t>(controls_.size()) - 1;
    if (i < 0) return 2. * controls_.front() - controls_[static_cast<std::size_t>(-i)];
    if (i > last) return 2. * controls_.back() - controls_[static_cast<std::size_t>(2 * last - i)];
    return controls_[static_cast<std::size_t>(i)];
}

/// Minimises the sum of squared second differences by projected successive over-relaxation.
void SmoothPath::relax(const PathTolerance& tolerance) {
    const std::vector<Station> legs = controls_;
    // What three control points on the legs around a corner leave of the tolerance.
    const double position =
        std::max(0.5 * tolerance.position, tolerance.position - 0.25 * step_ * limits_.maxSpeed);
    const auto last = static_cast<std::ptrdiff_t>(legs.size()) - 1;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (std::ptrdiff_t i = 1; i < last; ++i) {
            const Station least =
                (4. * (control(i - 1) + control(i + 1)) - control(i - 2) - control(i + 2)) / 6.;
            const auto k = static_cast<std::size_t>(i);
            Station off = controls_[k] + kOverRelaxation * (least - controls_[k]) - legs[k];
            const double distance = off.head<3>().norm();
            if (distance > position) off.head<3>() *= position / distance;
            off[3] = std::clamp(off[3], -tolerance.yaw, tolerance.yaw);
            controls_[k] = legs[k] + off;
        }
    }
}

/// By the limits at each control point, then backward by what can be braked.
void SmoothPath::limitRates() {
    const auto last = static_cast<std::ptrdiff_t>(controls_.size()) - 1;
    std::vector<double> here;
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        const Norms first = larger(normsOf(slope(i - 1)), normsOf(slope(i)));
        const Norms second = normsOf(bend(i));
        here.push_back(std::min(
            {1.,
             squaredRate(first.position, second.position, limits_.maxSpeed,
                         limits_.maxAcceleration),
             squaredRate(first.yaw, second.yaw, limits_.maxYawRate, limits_.maxYawAcceleration)}));
    }
    squaredRates_ = here;
    squaredRates_.back() = 0.;
    for (std::ptrdiff_t i = last - 1; i >= 0; --i) {
        const auto k = static_cast<std::size_t>(i);
        const Norms first =
            larger(normsOf(slope(i - 1)), larger(normsOf(slope(i)), normsOf(slope(i + 1))));
        const Norms second = larger(normsOf(bend(i)), normsOf(bend(i + 1)));
        const double next = squaredRates_[k + 1];
        squaredRates_[k] = std::min(
            {here[k > 0 ? k - 1 : 0], here[k], here[k + 1],
             brakedFrom(next, step_, first.position, second.position, limits_.maxAcceleration),
             brakedFrom(next, step_, first.yaw, second.yaw, limits_.maxYawAcceleration)});
    }
}

SmoothPath::Point SmoothPath::at(double phase) const {
    const double knots = std::clamp(phase, 0., end()) / step_;
    const auto i = static_cast<std::ptrdiff_t>(std::lround(knots));
    const double x = step_ * (knots - static_cast<double>(i));  // from the control point [s]
    const Station bent = bend(i);
    const Station first = 0.5 * (slope(i - 1) + slope(i));
    const Station middle = (control(i - 1) + 6. * control(i) + control(i + 1)) / 8.;
    return {middle + x * first + 0.5 * x * x * bent, first + x * bent, bent};
}

double SmoothPath::rateLimit(double phase) const {
    const double knots = std::clamp(phase, 0., end()) / step_;
    const auto i = std::min(static_cast<std::size_t>(knots), squaredRates_.size() - 2);
    const double share = knots - static_cast<double>(i);
    return std::sqrt((1. - share) * squaredRates_[i] + share * squaredRates_[i + 1]);
}

double SmoothPath::rateGrowth(double phase, double rate) const {
    const Point here = at(phase);
    const Norms first = normsOf(here.first), second = normsOf(here.second);
    const auto growth = [&](double slope, double bend, double acceleration) {
        return slope > 0. ? std::max(0., acceleration - bend * rate * rate) / slope : kAtOnce;
    };
    return std::min({kAtOnce, growth(first.position, second.position, limits_.maxAcceleration),
                     growth(first.yaw, second.yaw, limits_.maxYawAcceleration)});
}

}  // namespace photonav
