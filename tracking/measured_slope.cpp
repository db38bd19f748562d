// SPDX-License-Identifier: BSD-3-Clause
#include "measured_slope.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "se3.hpp"

namespace photonav {
namespace {

constexpr double kRelevant = 0.02;  // information, in units of the prior's: less changes nothing
constexpr double kLongest = 0.1;    // walk [mean depths, rad]
constexpr double kLeastSeen = 0.8;  // of the pixels: what is no longer in view is not the same

/// What J claims to tell, along six directions that it keeps apart.
struct Claims {
    Matrix6
        sigmas;    ///< columns, each as long as the image alone leaves it uncertain: where a
                   ///< claim is relevant sigmas^T J^T J sigmas is 1, otherwise they are the prior's
    Vector6 told;  ///< information along them, in units of the prior's
    Vector6 unit;  ///< (depth x 3, 1 x 3)

    bool isRelevant(int i) const { return told[i] > kRelevant; }
};

Claims claimsOf(const NormalEquations& here, const std::optional<Matrix6>& prior) {
    const Matrix6 JtJ = here.AtA.topLeftCorner<6, 6>();
    Claims claims;
    claims.unit << Eigen::Vector3d::Constant(1. / here.meanInverseDepth), Eigen::Vector3d::Ones();
    Matrix6 P = claims.unit.cwiseAbs2().asDiagonal();
    // A prior may be certain of some directions: by as little as does not matter, it is not.
    if (prior) P = *prior + 1e-10 * P;
    const Matrix6 L = P.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(L.transpose() * JtJ * L);
    claims.told = solver.eigenvalues();
    claims.sigmas = L * solver.eigenvectors();
    for (int i = 0; i < 6; ++i) {
        if (claims.isRelevant(i)) claims.sigmas.col(i) /= std::sqrt(claims.told[i]);
    }
    return claims;
}

/// Whether the floor is above a displacement of one standard deviation.
bool isBelowFloor(const Vector6& xi, const TrustOptions& floors) {
    return xi.head<3>().norm() <= floors.floorTranslation &&
           xi.tail<3>().norm() <= floors.floorRotation;
}

/// W with singular values above 1 made 1: no direction then tells more than its claim.
Matrix6 atMostOne(const Matrix6& W) {
    const Eigen::JacobiSVD<Matrix6> svd(W, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.singularValues().cwiseMin(1.).asDiagonal() *
           svd.matrixV().transpose();
}

}  // namespace

Matrix6 measuredSlope(const std::optional<Matrix6>& prior, const TrustOptions& floors,
                      const Walk& walk) {
    const NormalEquations here = walk(Pose::Identity());
    if (here.count < 1.) return Matrix6::Identity();
    const Claims claims = claimsOf(here, prior);
    Matrix6 W = Matrix6::Identity();  // M from claim to claim
    for (int i = 0; i < 6; ++i) {
        const Vector6 sigma = claims.sigmas.col(i);
        if (!claims.isRelevant(i) || isBelowFloor(sigma, floors)) continue;
        // No farther than image and prior together leave open.
        const double together = std::sqrt(claims.told[i] / (1. + claims.told[i]));
        const double step = std::min(together, kLongest / sigma.cwiseQuotient(claims.unit).norm());
        const NormalEquations ahead = walk(expSE3(step * sigma));
        const NormalEquations behind = walk(expSE3(-step * sigma));
        if (std::min(ahead.count, behind.count) < kLeastSeen * here.count) continue;
        const Vector6 JtD =
            (behind.Atr * here.count / behind.count - ahead.Atr * here.count / ahead.count)
                .head<6>() /
            (2. * step);
        for (int j = 0; j < 6; ++j) {
            W(j, i) = claims.isRelevant(j) ? claims.sigmas.col(j).dot(JtD) : 0.;
        }
    }
    return claims.sigmas * atMostOne(W) * claims.sigmas.inverse();
}

}  // namespace photonav
