// SPDX-License-Identifier: BSD-3-Clause
#include "shapes/paths.hpp"

#include <algorithm>
#include <limits>

namespace photonav {
namespace {

double distanceFromAbove(const DrawnPath& path, const Eigen::Vector2d& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < path.points.size(); ++i) {
        const Eigen::Vector2d a = path.points[i - 1].position.head<2>();
        const Eigen::Vector2d leg = path.points[i].position.head<2>() - a;
        const double t = leg.dot(p - a) / std::max(leg.squaredNorm(), 1e-12);
        least = std::min(least, (a + std::clamp(t, 0., 1.) * leg - p).norm());
    }
    return least;
}

}  // namespace

PathPoint makePathPoint(const UncertainPose& T_c_w, double trace, double distance, double cost) {
    const Pose T_w_c = T_c_w.mean.inverse();
    const Eigen::Matrix3d R_w_c = T_w_c.linear();
    return {
        .position = T_w_c.translation(),
        .T_w_c = T_w_c,
        .trace = trace,
        .positionCovariance = R_w_c * T_c_w.covariance.topLeftCorner<3, 3>() * R_w_c.transpose(),
        .distance = distance,
        .cost = cost};
}

void append(DrawnPath& path, PathPoint point) {
    if (!path.points.empty()) {
        const PathPoint& last = path.points.back();
        point.distance = last.distance + (point.position - last.position).norm();
    }
    path.points.push_back(point);
}

bool runsAlong(const DrawnPath& path, const DrawnPath& other, double tolerance) {
    const auto near = std::ranges::count_if(path.points, [&](const PathPoint& point) {
        return distanceFromAbove(other, point.position.head<2>()) < tolerance;
    });
    return 2 * near > std::ssize(path.points);
}

}  // namespace photonav
