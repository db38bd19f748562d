// SPDX-License-Identifier: BSD-3-Clause
#include "check/obstruction.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/constants.hpp"

namespace photonav {
namespace {

constexpr double kLookEvery = 0.02;  // between the places looked at [m]

/// Stretches of places that have something in common, seen in their order.
class Stretches {
  public:
    void see(double length, bool isInside) {
        if (isInside && !isOpen_) stretches_.push_back({length, length});
        if (isInside) stretches_.back().end = length;
        isOpen_ = isInside;
    }
    std::vector<Stretch> take() { return std::move(stretches_); }

  private:
    std::vector<Stretch> stretches_;
    bool isOpen_ = false;
};

}  // namespace

Obstruction obstructionOf(const GivenTrajectory& trajectory, const Config& config,
                          const World& world, const std::atomic<bool>& interrupted) {
    Obstruction found{.leastClearance = kInfinity};
    const auto known = world.distancesWithoutUnknown(config);
    Stretches collisions, unknown, outside;
    const auto see = [&](const Eigen::Vector3d& p_w, double length) {
        const bool isOutside = !config.bounds.contains(p_w);
        outside.see(length, isOutside);
        const double clearance = isOutside ? kInfinity : world.clearance(p_w);
        const bool isBlocked = clearance <= config.robotRadius;
        const bool isUnknown = isBlocked && known && known->clearance(p_w) > config.robotRadius;
        collisions.see(length, isBlocked && !isUnknown);
        unknown.see(length, isUnknown);
        found.leastClearance = std::min(found.leastClearance, clearance);
    };
    double length = 0.;
    Eigen::Vector3d last = trajectory.poses.front().T_w_b.translation();
    see(last, 0.);
    for (const GivenPose& pose : trajectory.poses) {
        const Eigen::Vector3d way = pose.T_w_b.translation() - last;
        const int steps = static_cast<int>(std::ceil(way.norm() / kLookEvery));
        for (int k = 1; k <= steps && !interrupted; ++k) {
            const double share = static_cast<double>(k) / steps;
            see(last + share * way, length + share * way.norm());
        }
        length += way.norm();
        last += way;
    }
    found.collisions = collisions.take();
    found.unknown = unknown.take();
    found.outside = outside.take();
    return found;
}

}  // namespace photonav
