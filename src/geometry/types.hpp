// SPDX-License-Identifier: BSD-3-Clause
// Types that are used by all modules, and their conventions.
//
// Frames. w: world, x forward, y left, z up. b: body, x forward, y left, z up. c: camera, optical
// frame, x right, y down, z forward. T_a_b maps coordinates in b to coordinates in a (ViSP's aMb).
// Twists are (rho, phi): translation first, as ViSP's (v, omega). SI units, radians.
#pragma once

#include <visp3/core/vpImage.h>

#include <Eigen/Dense>

namespace photonav {

using Pose = Eigen::Isometry3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using ImageF = vpImage<float>;

}  // namespace photonav
