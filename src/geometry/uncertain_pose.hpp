// SPDX-License-Identifier: BSD-3-Clause
// Poses with covariance: propagation along motions and update by information.
//
// A belief is T = exp(xi^) mean with xi ~ N(0, covariance), xi in the frame the pose maps into (for
// T_c_w: the camera frame), on the left, ordered (rho, phi). Units m^2, m rad, rad^2.
#pragma once

#include "geometry/types.hpp"

namespace photonav {

struct UncertainPose {
    Pose mean = Pose::Identity();
    Matrix6 covariance = Matrix6::Zero();
};

enum class PropagationOrder { second, fourth };

/// Rotation standard deviation [rad] beyond which the fourth-order terms are not trusted. Against
/// Monte Carlo they are closer than the second order alone in the Frobenius norm up to 1.3 rad in
/// either factor, in trace only up to 1 rad.
inline constexpr double kFourthOrderMaxRotationSigma = 1.0;

struct CompoundedCovariance {
    Matrix6 covariance;
    bool fellBack = false;  ///< fourth order was requested but second order computed (see below)
};

/// The fourth-order terms of the covariance of a product of independent factors, BF14 eq. (55):
/// B / 4 + (A1 S2 + S2 A1^T + A2 S1 + S1 A2^T) / 12, without any guard.
/// @param first covariance S1 of the left factor, in the frame the product maps into
/// @param second covariance S2 of the right factor, transformed into the same frame by the adjoint
Matrix6 fourthOrderTerms(const Matrix6& first, const Matrix6& second);

/// Covariance of T_c_a = T_c_b T_b_a for independent factors, BF14 eq. (55) ff.
///
/// Second order is motion + Ad(T_c_b) prior Ad(T_c_b)^T; fourth order adds fourthOrderTerms. Fourth
/// order falls back to second where the rotation standard deviation sqrt(tr(phi block)) of a factor
/// exceeds kFourthOrderMaxRotationSigma or the sum would lose positive semi-definiteness.
/// Costs about 0.2 us (bench/uncertain_pose_bench); the planner calls it millions of times.
/// @param adjointMotion Ad of the mean motion T_c_b
/// @param motion covariance of T_c_b, in frame c
/// @param prior covariance of T_b_a, in frame b
CompoundedCovariance compoundCovariance(const Matrix6& adjointMotion, const Matrix6& motion,
                                        const Matrix6& prior, PropagationOrder order);

/// T_c_a = T_c_b T_b_a with its covariance.
UncertainPose compound(const UncertainPose& T_c_b, const UncertainPose& T_b_a,
                       PropagationOrder order = PropagationOrder::fourth);

/// The covariance of a perturbation in frame a, expressed in frame b: Ad(T_b_a) covariance
/// Ad(T_b_a)^T. With T_b_a = T_c_b it turns a covariance in body axes into one in camera axes.
Matrix6 inOtherFrame(const Matrix6& covariance, const Pose& T_b_a);

/// T_a_b from T_b_a: the covariance is transformed to frame a by the adjoint.
UncertainPose inverse(const UncertainPose& T_b_a);

/// Covariance after a measurement with Fisher information `information` in the same frame:
/// (information + covariance^-1)^-1, computed as (1 + covariance information)^-1 covariance, which
/// holds for singular (also zero) covariance and information. The result is symmetric.
Matrix6 updateCovariance(const Matrix6& covariance, const Matrix6& information);

/// How far a pose is from a belief's mean: translation and rotation vector of T_c_w T_mean_w^-1.
Vector6 deviation(const Pose& T_c_w, const Pose& T_mean_w);

/// The covariance of a belief, expressed in the camera frame of a pose that deviates by e from its
/// mean. The rotation part is transformed by the left Jacobian of SO(3). The translation part is
/// rotated by the whole rotation vector of e, not by half of it as in the left Jacobian of SE(3),
/// because the positions are known relative to the map, which does not rotate. (With half of the
/// rotation, 3 mrad of error would turn 1 m of uncertainty along a wall 1.5 mm into the wall.)
Matrix6 transported(const Matrix6& covariance, const Vector6& e);

/// Whether a matrix is a covariance: finite, symmetric and positive semi-definite, both within
/// 1e-12 of its scale. Use it on input; the functions above do not check.
bool isCovariance(const Matrix6& matrix);

/// tr_W(covariance) = tr(rho block) + characteristicLength^2 tr(phi block) [m^2]. A rotation error
/// is counted as the displacement that it causes at a distance of characteristicLength [m].
double weightedTrace(const Matrix6& covariance, double characteristicLength = 1.0);

}  // namespace photonav
