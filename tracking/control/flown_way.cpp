// SPDX-License-Identifier: BSD-3-Clause
#include "control/flown_way.hpp"

#include <cmath>

namespace photonav {
namespace {

constexpr double kApart = 0.05;     // of the poses kept: a route bends as far from its legs [m]
constexpr double kTurnApart = 0.1;  // the same of headings [rad]

bool areApart(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm() > kApart ||
           Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() > kTurnApart;
}

}  // namespace

void FlownWay::moved(const Pose& T_w_b, const Pose& T_w_certain) {
    if (poses_.empty() || poses_.front().matrix() != T_w_certain.matrix()) poses_ = {T_w_certain};
    if (areApart(poses_.back(), T_w_b)) poses_.push_back(T_w_b);
    now_ = T_w_b;
}

std::vector<PlannedView> FlownWay::back() const {
    std::vector<PlannedView> plan{{.T_w_b = now_}};
    for (auto pose = poses_.rbegin(); pose != poses_.rend(); ++pose) {
        const double leg = (pose->translation() - plan.back().T_w_b.translation()).norm();
        plan.push_back({.T_w_b = *pose, .distance = plan.back().distance + leg});
    }
    return plan;
}

double FlownWay::length() const { return back().back().distance; }

}  // namespace photonav
