// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/measured_slope.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "geometry/eigensystem.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr double kRelevant = 0.02;   // information, in units of the prior's
constexpr double kLongest = 0.1;     // displacement [mean depths, rad]
constexpr double kMinVisible = 0.8;  // share of the pixels

/// Six directions conjugate in J^T J, and the information of J along them.
struct Directions {
    /// Columns, of one standard deviation by the image alone: where the information is relevant
    /// sigmas^T J^T J sigmas is 1; otherwise of one standard deviation of the prior.
    Matrix6 sigmas;
    Vector6 information;  ///< along them, in units of the prior's
    Vector6 unit;         ///< (depth x 3, 1 x 3)

    bool isRelevant(int i) const { return information[i] > kRelevant; }
};

Directions directionsOf(const NormalEquations& here, const std::optional<Matrix6>& prior) {
    const Matrix6 JtJ = here.AtA.topLeftCorner<6, 6>();
    Directions along;
    along.unit << Eigen::Vector3d::Constant(1. / here.meanInverseDepth), Eigen::Vector3d::Ones();
    Matrix6 P = along.unit.cwiseAbs2().asDiagonal();
    // A prior may have directions without variance: a negligible variance makes it invertible.
    if (prior) P = *prior + 1e-10 * P;
    const Matrix6 L = P.llt().matrixL();
    const auto [values, vectors] = eigensystem(L.transpose() * JtJ * L);
    along.information = values;
    along.sigmas = L * vectors;
    for (int i = 0; i < 6; ++i) {
        if (along.isRelevant(i)) along.sigmas.col(i) /= std::sqrt(along.information[i]);
    }
    return along;
}

/// Whether the least standard deviation is above a displacement of one standard deviation.
bool isBelowLeastSigma(const Vector6& xi, const TrustOptions& trust) {
    return xi.head<3>().norm() <= trust.leastSigma &&
           xi.tail<3>().norm() <= trust.leastSigmaRotation;
}

/// W with singular values limited to 1, so that no direction has more information than J gives.
Matrix6 atMostOne(const Matrix6& W) {
    const Eigen::JacobiSVD<Matrix6> svd(W, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.singularValues().cwiseMin(1.).asDiagonal() *
           svd.matrixV().transpose();
}

}  // namespace

Matrix6 measuredSlope(const std::optional<Matrix6>& prior, const TrustOptions& trust,
                      const DisplacedComparison& compare) {
    const NormalEquations here = compare(Pose::Identity());
    if (here.count < 1.) return Matrix6::Identity();
    const Directions along = directionsOf(here, prior);
    Matrix6 W = Matrix6::Identity();  // M from direction to direction
    for (int i = 0; i < 6; ++i) {
        const Vector6 sigma = along.sigmas.col(i);
        if (!along.isRelevant(i) || isBelowLeastSigma(sigma, trust)) continue;
        // No farther than one standard deviation given image and prior.
        const double together = std::sqrt(along.information[i] / (1. + along.information[i]));
        const double step = std::min(together, kLongest / sigma.cwiseQuotient(along.unit).norm());
        const NormalEquations ahead = compare(expSE3(step * sigma));
        const NormalEquations behind = compare(expSE3(-step * sigma));
        if (std::min(ahead.count, behind.count) < kMinVisible * here.count) continue;
        const Vector6 JtD =
            (behind.Atr * here.count / behind.count - ahead.Atr * here.count / ahead.count)
                .head<6>() /
            (2. * step);
        for (int j = 0; j < 6; ++j) {
            W(j, i) = along.isRelevant(j) ? along.sigmas.col(j).dot(JtD) : 0.;
        }
    }
    return along.sigmas * atMostOne(W) * along.sigmas.inverse();
}

}  // namespace photonav
