// SPDX-License-Identifier: BSD-3-Clause
// Points and line segments.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace photonav {

/// How far along the segment from a to b its point nearest to p lies: 0 at a, 1 at b. 0 for a
/// segment without length.
inline double nearestOnSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                               const Eigen::Vector3d& b) {
    const Eigen::Vector3d way = b - a;
    const double squared = way.squaredNorm();
    return squared > 0. ? std::clamp((p - a).dot(way) / squared, 0., 1.) : 0.;
}

/// [m]
inline double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b) {
    return (p - a - nearestOnSegment(p, a, b) * (b - a)).norm();
}

}  // namespace photonav
