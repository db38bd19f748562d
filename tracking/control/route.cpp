// SPDX-License-Identifier: BSD-3-Clause
#include "control/route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "geometry/constants.hpp"
#include "geometry/se3.hpp"

namespace photonav {

Route::Route(std::vector<PlannedView> plan, const Pose& T_b_c, const RouteOptions& options)
    : plan_(std::move(plan)), T_b_c_(T_b_c), options_(options) {
    if (plan_.size() < 2) throw std::invalid_argument("flight: a plan has at least two views");
}

bool Route::isReached(const UncertainPose& belief) const {
    const double sigma = std::sqrt(belief.covariance.topLeftCorner<3, 3>().trace());
    const double tolerance =
        std::clamp(options_.toleranceSigmas * sigma, options_.minTolerance, options_.maxTolerance);
    const Pose T_w_b = bodyOf(belief.mean);
    const double distance = (T_w_b.translation() - target().T_w_b.translation()).norm();
    // Of the headings: tilt cannot be commanded.
    const double turn = std::remainder(yawOf(T_w_b) - yawOf(target().T_w_b), 2. * std::numbers::pi);
    return distance < tolerance && std::abs(turn) < options_.yawTolerance;
}

const PlannedView& Route::advance(const UncertainPose& belief) {
    const Eigen::Vector3d p_w = bodyOf(belief.mean).translation();
    atGoal_ = false;  // a search may have led away from it
    for (;;) {
        if (target().isWaypoint || target_ + 1 == plan_.size()) {
            if (!isReached(belief)) break;
            passed_ = target_;
            if (target_ + 1 == plan_.size()) {
                atGoal_ = true;
                break;
            }
        } else if ((p_w - target().T_w_b.translation()).norm() > options_.lookahead) {
            break;
        }
        ++target_;
    }
    return target();
}

double Route::progress(const Pose& T_c_w) const {
    const Eigen::Vector3d p_w = bodyOf(T_c_w).translation();
    double least = kInfinity;
    double distance = target().distance;  // at the goal there is no way left
    for (std::size_t i = passed_; i < target_; ++i) {
        const Eigen::Vector3d from = plan_[i].T_w_b.translation();
        const Eigen::Vector3d way = plan_[i + 1].T_w_b.translation() - from;
        const double square = std::max(way.squaredNorm(), 1e-12);
        const double t = std::clamp((p_w - from).dot(way) / square, 0., 1.);
        const double away = (p_w - from - t * way).norm();
        if (away >= least) continue;
        least = away;
        distance = plan_[i].distance + t * (plan_[i + 1].distance - plan_[i].distance);
    }
    return distance;
}

}  // namespace photonav
