// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace photonav {

/// The command of a near-hover controller: velocity of the body in its own axes.
struct BodyVelocity {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();  ///< [m/s]
    double yawRate = 0.;                               ///< about the body's z axis [rad/s]
};

}  // namespace photonav
