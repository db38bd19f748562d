// SPDX-License-Identifier: BSD-3-Clause
// Points and line segments.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace photonav {

/// Where on the segment from a to b the point nearest to p lies, as a fraction: 0 at a, 1 at b. The
/// result is 0 if a and b are equal.
inline double nearestOnSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                               const Eigen::Vector3d& b) {
    const Eigen::Vector3d way = b - a;
    const double squared = way.squaredNorm();
    return squared > 0. ? std::clamp((p - a).dot(way) / squared, 0., 1.) : 0.;
}

/// Distance from the point p to the segment from a to b [m].
inline double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b) {
    return (p - a - nearestOnSegment(p, a, b) * (b - a)).norm();
}

}  // namespace photonav
