// SPDX-License-Identifier: BSD-3-Clause
// SE(3) in the notation of Barfoot and Furgale, "Associating Uncertainty With Three-Dimensional
// Poses for Use in Estimation Problems", T-RO 2014 (cited as BF14). Twists are (rho, phi).
#pragma once

#include "geometry/types.hpp"

namespace photonav {

/// phi^: the cross-product matrix, phi^ v = phi x v.
Eigen::Matrix3d hat(const Eigen::Vector3d& phi);

/// exp(xi^), BF14 eq. (3): rotation exp(phi^), translation J(phi) rho.
Pose expSE3(const Vector6& xi);

/// The twist with expSE3(logSE3(T)) = T and a rotation angle in [0, pi].
Vector6 logSE3(const Pose& T);

/// The pose at the fraction s in [0, 1] between a and b: the position is interpolated on the
/// straight line, the orientation along the shortest rotation.
Pose interpolate(const Pose& a, const Pose& b, double s);

/// Pose T_w_b of a level body (x forward, z up).
/// @param yaw heading about the world's z axis [rad]
Pose levelPose(const Eigen::Vector3d& p_w, double yaw);

/// Heading of a body about the world's z axis [rad].
double yawOf(const Pose& T_w_b);

/// Ad(T) = [C, r^ C; 0, C]: T exp(xi^) T^-1 = exp((Ad(T) xi)^), BF14 eq. (4).
Matrix6 adjoint(const Pose& T);

/// A covariance or information matrix of a twist in axes rotated by R, about the same point:
/// diag(R, R) matrix diag(R, R)^T. `matrix` must be symmetric; the result is exactly symmetric.
Matrix6 inRotatedAxes(const Matrix6& matrix, const Eigen::Matrix3d& R);

/// Left Jacobian of SE(3): exp((xi + d)^) = exp((J(xi) d)^) exp(xi^) to first order in d, BF14
/// eq. (100).
Matrix6 leftJacobian(const Vector6& xi);

/// Inverse of the left Jacobian. Singular at rotations of 2 pi only.
Matrix6 leftJacobianInverse(const Vector6& xi);

}  // namespace photonav
