// SPDX-License-Identifier: BSD-3-Clause
// Estimates the direction up from the plane of the floor.
#pragma once

#include <optional>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

struct FloorOptions {
    double tolerance = 0.02;  ///< distance of a point that belongs to a plane [m]
    double maxTilt = 0.87;    ///< of the plane's normal from the rough direction [rad]
    int trials = 2000;
    unsigned seed = 1;
};

/// The upward normal of the plane that most of the points lie on, by RANSAC with a fixed seed and a
/// least-squares fit to the inliers. Tables and ceilings serve as well as the floor itself.
/// @param points in any frame w [m]; points above the camera that saw them must be left out
/// @param roughUp unit vector in w, within maxTilt of the truth
/// @return unit vector in w; nothing when less than a tenth of the points agree on a plane
std::optional<Eigen::Vector3d> floorNormal(const std::vector<Eigen::Vector3d>& points,
                                           const Eigen::Vector3d& roughUp,
                                           const FloorOptions& options = {});

}  // namespace photonav
