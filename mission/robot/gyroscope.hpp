// SPDX-License-Identifier: BSD-3-Clause
// The gyroscope of a robot that flies.
#pragma once

#include "geometry/types.hpp"

namespace photonav {

/// Fisher information of the rotation that a gyroscope measures, about the motion of its body.
/// @param noise standard deviation of the rotation over one second [rad], above 0
/// @param seconds duration of the motion, above 0
/// @return for a perturbation (rho, phi) of the motion
inline Matrix6 gyroscopeInformation(double noise, double seconds) {
    Matrix6 information = Matrix6::Zero();
    information.bottomRightCorner<3, 3>().diagonal().setConstant(1. / (noise * noise * seconds));
    return information;
}

}  // namespace photonav
