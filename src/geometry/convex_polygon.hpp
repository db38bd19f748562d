// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace photonav {

/// Whether a point is in a convex polygon, or on its border.
/// @param polygon its corners in order, in either direction
inline bool isInConvexPolygon(const Eigen::Vector2d& p,
                              const std::vector<Eigen::Vector2d>& polygon) {
    bool isLeft = false, isRight = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d side = polygon[(i + 1) % polygon.size()] - polygon[i];
        const Eigen::Vector2d way = p - polygon[i];
        const double cross = side.x() * way.y() - side.y() * way.x();
        isLeft = isLeft || cross > 0.;
        isRight = isRight || cross < 0.;
    }
    return !(isLeft && isRight);
}

}  // namespace photonav
