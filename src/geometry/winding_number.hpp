// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace photonav {

/// How often a closed polygon goes around a point, counter-clockwise; 0 for a point outside.
/// @param corners in order; the last one is joined to the first one
inline int windingNumber(std::span<const Eigen::Vector2d> corners, const Eigen::Vector2d& p) {
    int turns = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d a = corners[i] - p;
        const Eigen::Vector2d b = corners[(i + 1) % corners.size()] - p;
        const bool isUpward = a.y() <= 0. && b.y() > 0.;
        const bool isDownward = a.y() > 0. && b.y() <= 0.;
        const double cross = a.x() * b.y() - a.y() * b.x();
        // Sides that cross the ray from p along +x.
        if (isUpward && cross > 0.) ++turns;
        if (isDownward && cross < 0.) --turns;
    }
    return turns;
}

}  // namespace photonav
