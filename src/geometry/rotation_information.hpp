// SPDX-License-Identifier: BSD-3-Clause
// What a measured rotation, such as that of a gyroscope, says about a pose or a motion.
#pragma once

#include "geometry/types.hpp"

namespace photonav {

/// Fisher information of a measured rotation about a perturbation (rho, phi).
/// @param variance of the measurement about each axis [rad^2], above 0
inline Matrix6 rotationInformation(double variance) {
    Matrix6 information = Matrix6::Zero();
    information.bottomRightCorner<3, 3>().diagonal().setConstant(1. / variance);
    return information;
}

}  // namespace photonav
