// SPDX-License-Identifier: BSD-3-Clause
#include "path_overlap.hpp"

#include <algorithm>

#include "constants.hpp"

namespace photonav {
namespace {

double distanceFromAbove(const DrawnPath& path, const Eigen::Vector2d& p) {
    double least = kInfinity;
    for (std::size_t i = 1; i < path.points.size(); ++i) {
        const Eigen::Vector2d a = path.points[i - 1].position.head<2>();
        const Eigen::Vector2d leg = path.points[i].position.head<2>() - a;
        const double t = leg.dot(p - a) / std::max(leg.squaredNorm(), 1e-12);
        least = std::min(least, (a + std::clamp(t, 0., 1.) * leg - p).norm());
    }
    return least;
}

}  // namespace

bool runsAlong(const DrawnPath& path, const DrawnPath& other, double tolerance) {
    const auto near = std::ranges::count_if(path.points, [&](const PathPoint& point) {
        return distanceFromAbove(other, point.position.head<2>()) < tolerance;
    });
    return 2 * near > std::ssize(path.points);
}

}  // namespace photonav
