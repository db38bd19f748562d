// SPDX-License-Identifier: BSD-3-Clause
#include "measured_slope.hpp"

#include <Eigen/Eigenvalues>
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
    Matrix6 directions;  ///< columns, of one standard deviation of the prior
    Vector6 told;        ///< information along them: directions^T J^T J directions is diagonal
    Vector6 unit;        ///< (depth x 3, 1 x 3)
};

Claims claimsOf(const NormalEquations& here, const std::optional<Matrix6>& prior) {
    const Matrix6 JtJ = here.AtA.topLeftCorner<6, 6>();
    Vector6 unit;
    unit << Eigen::Vector3d::Constant(1. / here.meanInverseDepth), Eigen::Vector3d::Ones();
    Matrix6 P = unit.cwiseAbs2().asDiagonal();
    // A prior may be certain of some directions: by as little as does not matter, it is not.
    if (prior) P = *prior + 1e-10 * P;
    const Matrix6 L = P.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(L.transpose() * JtJ * L);
    return {L * solver.eigenvectors(), solver.eigenvalues(), unit};
}

/// Whether the floor is above a displacement of one standard deviation.
bool isBelowFloor(const Vector6& xi, const TrustOptions& floors) {
    return xi.head<3>().norm() <= floors.floorTranslation &&
           xi.tail<3>().norm() <= floors.floorRotation;
}

}  // namespace

Matrix6 measuredSlope(const std::optional<Matrix6>& prior, const TrustOptions& floors,
                      const Walk& walk) {
    const NormalEquations here = walk(Pose::Identity());
    if (here.count < 1.) return Matrix6::Identity();
    const Claims claims = claimsOf(here, prior);
    const Vector6& told = claims.told;
    const Eigen::Array<bool, 6, 1> isRelevant = told.array() > kRelevant;
    Matrix6 M = Matrix6::Identity();  // from claim to claim
    for (int i = 0; i < 6; ++i) {
        const Vector6 direction = claims.directions.col(i);
        const Vector6 sigma = direction / std::sqrt(told[i]);
        if (!isRelevant[i] || isBelowFloor(sigma, floors)) continue;
        const double length = sigma.cwiseQuotient(claims.unit).norm();
        const double step = std::min(1., kLongest / length);
        const NormalEquations ahead = walk(expSE3(step * sigma));
        const NormalEquations behind = walk(expSE3(-step * sigma));
        if (std::min(ahead.count, behind.count) < kLeastSeen * here.count) continue;
        const Vector6 JtD = claims.directions.transpose() * (behind.Atr - ahead.Atr).head<6>() /
                            (2. * step / std::sqrt(told[i]));
        M.col(i) = isRelevant.select(JtD.cwiseQuotient(told), 0.);
        const double measured = M.col(i).cwiseAbs2().dot(told);
        if (measured > told[i]) M.col(i) *= std::sqrt(told[i] / measured);
    }
    return claims.directions * M * claims.directions.inverse();
}

}  // namespace photonav
