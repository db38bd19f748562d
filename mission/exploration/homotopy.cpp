// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/homotopy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/constants.hpp"
#include "geometry/winding_number.hpp"

namespace photonav {
namespace {

constexpr double kGrid = 0.1;  // [m]

/// Whether a place of the grid is at an obstacle at some height, and the robot has no room there at
/// any.
bool isObstacle(const std::function<double(const Eigen::Vector3d&)>& clearance, double radius,
                const Eigen::Vector2d& p_w, const Eigen::AlignedBox3d& bounds_w) {
    constexpr double kAtObstacle = 0.5 * std::numbers::sqrt2 * kGrid;
    double least = kInfinity;
    const double height = bounds_w.sizes().z();
    const int steps = static_cast<int>(std::ceil(height / kGrid));
    for (int i = 0; i <= steps; ++i) {
        const double z = bounds_w.min().z() + height * i / std::max(steps, 1);
        const double here = clearance({p_w.x(), p_w.y(), z});
        if (here >= radius) return false;
        least = std::min(least, here);
    }
    return least <= kAtObstacle;
}

}  // namespace

HomotopyClasses::HomotopyClasses(const std::function<double(const Eigen::Vector3d& p_w)>& clearance,
                                 double radius, const Eigen::AlignedBox3d& bounds_w) {
    const Eigen::Vector2d least = bounds_w.min().head<2>();
    const Eigen::Vector2d sizes = bounds_w.sizes().head<2>();
    for (int i = 0; kGrid * i <= sizes.x(); ++i) {
        for (int j = 0; kGrid * j <= sizes.y(); ++j) {
            const Eigen::Vector2d p_w = least + kGrid * Eigen::Vector2d(i, j);
            if (isObstacle(clearance, radius, p_w, bounds_w)) obstacles_w_.push_back(p_w);
        }
    }
}

bool HomotopyClasses::areSame(const GroundTrack& a, const GroundTrack& b) const {
    GroundTrack thereAndBack = a;
    thereAndBack.insert(thereAndBack.end(), b.rbegin(), b.rend());
    Eigen::AlignedBox2d around;
    for (const Eigen::Vector2d& p_w : thereAndBack) around.extend(p_w);
    return std::none_of(obstacles_w_.begin(), obstacles_w_.end(), [&](const Eigen::Vector2d& p_w) {
        return around.contains(p_w) && windingNumber(thereAndBack, p_w) != 0;
    });
}

double flownUntilDecided(const ExplorationResult& flight, const Pose& T_b_c,
                         const HomotopyClasses& classes) {
    double decided = std::numeric_limits<double>::quiet_NaN();
    GroundTrack backward;  // the way flown from its end on
    auto sample = flight.samples.rbegin();
    for (std::size_t i = flight.plans.size(); i-- > 0;) {
        for (; sample != flight.samples.rend() && sample->time >= flight.updates[i].time;
             ++sample) {
            const Pose T_w_b = (T_b_c * sample->T_c_w).inverse();
            backward.emplace_back(T_w_b.translation().head<2>());
        }
        if (flight.plans[i].empty()) continue;
        const GroundTrack flown(backward.rbegin(), backward.rend());
        if (!classes.areSame(flight.plans[i], flown)) break;
        decided = sample != flight.samples.rend() ? sample->distance : 0.;
    }
    return decided;
}

}  // namespace photonav
