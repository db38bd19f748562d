// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/se3.hpp"

#include <gtest/gtest.h>
#include <visp3/core/vpExponentialMap.h>
#include <visp3/core/vpVelocityTwistMatrix.h>

#include <numbers>
#include <random>

#include "geometry/visp_bridge.hpp"

namespace photonav {
namespace {

/// Twists with rotation angles from nothing to nearly pi, in random directions.
std::vector<Vector6> twistSweep() {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<Vector6> twists;
    for (double angle :
         {0., 1e-300, 1e-160, 1e-12, 1e-8, 1e-4, 0.01, 0.3, 0.70710, 0.70712, 1., 2., 3.,
          std::numbers::pi - 1e-3, std::numbers::pi - 1e-6, std::numbers::pi - 1e-9}) {
        for (int i = 0; i < 20; ++i) {
            Vector6 xi;
            for (double& x : xi) x = normal(random);
            xi.tail<3>() = xi.tail<3>().normalized() * angle;
            twists.push_back(xi);
        }
    }
    for (int axis = 3; axis < 6; ++axis)
        twists.push_back(Vector6::Unit(axis) * (std::numbers::pi - 1e-9));
    return twists;
}

TEST(Se3, LogInvertsExpFromZeroToPi) {
    for (const Vector6& xi : twistSweep()) {
        // Near pi the axis, and with it rho, is only as good as the rotation matrix: 1e-15 / angle.
        EXPECT_LT((logSE3(expSE3(xi)) - xi).norm(), 2e-14) << xi.transpose();
    }
}

TEST(Se3, LogKeepsTinyRotationsToRelativePrecision) {
    Vector6 xi;
    xi << 1., -2., 3., 1e-12, -2e-12, 0.5e-12;
    const Vector6 back = logSE3(expSE3(xi));
    EXPECT_LT((back - xi).tail<3>().norm(), 1e-15 * xi.tail<3>().norm());
}

TEST(Se3, LogOfHalfTurnHasAnglePi) {
    Pose T = Pose::Identity();
    T.linear() = Eigen::Vector3d(-1., -1., 1.).asDiagonal();
    EXPECT_NEAR(logSE3(T).tail<3>().norm(), std::numbers::pi, 1e-15);
}

TEST(Se3, ExpAgreesWithVisp) {
    for (const Vector6& xi : twistSweep()) {
        const Pose visp = fromVisp(vpExponentialMap::direct(toVisp(xi)));
        // ViSP switches its series off below 1e-8 rad or so, hence not to the last bit.
        EXPECT_LT((expSE3(xi).matrix() - visp.matrix()).norm(), 1e-7) << xi.transpose();
        EXPECT_LT((expSE3(xi).linear() - visp.linear()).norm(), 1e-7) << xi.transpose();
    }
}

TEST(Se3, ExpAndLogAgreeWithVispAtOrdinaryAngles) {
    for (const Vector6& xi : twistSweep()) {
        const double angle = xi.tail<3>().norm();
        if (angle < 0.01 || angle > 3.1) continue;
        const vpHomogeneousMatrix visp = vpExponentialMap::direct(toVisp(xi));
        EXPECT_LT((expSE3(xi).matrix() - fromVisp(visp).matrix()).norm(), 1e-11);
        EXPECT_LT((logSE3(fromVisp(visp)) - twistFromVisp(vpExponentialMap::inverse(visp))).norm(),
                  1e-9);
    }
}

TEST(Se3, ExpIsARotation) {
    for (const Vector6& xi : twistSweep()) {
        const Eigen::Matrix3d C = expSE3(xi).linear();
        EXPECT_LT((C * C.transpose() - Eigen::Matrix3d::Identity()).norm(), 3e-15);
        EXPECT_NEAR(C.determinant(), 1., 3e-15);
    }
}

TEST(Se3, AdjointIsVispsVelocityTwistMatrix) {
    for (const Vector6& xi : twistSweep()) {
        const Pose T = expSE3(xi);
        vpVelocityTwistMatrix V;
        V.buildFrom(toVisp(T));
        EXPECT_LT((adjoint(T) - matrix6FromVisp(V)).norm(), 1e-14);
    }
}

TEST(Se3, AdjointCarriesPerturbations) {
    const std::vector<Vector6> twists = twistSweep();
    for (std::size_t i = 1; i < twists.size(); ++i) {
        const Pose T = expSE3(twists[i]);
        const Vector6& xi = twists[i - 1];
        const Pose conjugate = T * expSE3(xi) * T.inverse();
        EXPECT_LT((conjugate.matrix() - expSE3(adjoint(T) * xi).matrix()).norm(), 1e-13);
    }
}

TEST(Se3, LeftJacobianIsTheDerivativeOfExp) {
    constexpr double kStep = 1e-5;
    for (const Vector6& xi : twistSweep()) {
        const Pose inverse = expSE3(xi).inverse();
        Matrix6 numeric;
        for (int i = 0; i < 6; ++i) {
            const Vector6 d = kStep * Vector6::Unit(i);
            numeric.col(i) =
                (logSE3(expSE3(xi + d) * inverse) - logSE3(expSE3(xi - d) * inverse)) / (2 * kStep);
        }
        EXPECT_LT((leftJacobian(xi) - numeric).norm(), 2e-9) << xi.transpose();
    }
}

TEST(Se3, LeftJacobianIsContinuousWhereTheSeriesEnds) {
    Vector6 below;
    below << 1., 2., -3., std::sqrt(0.5) - 1e-12, 0., 0.;
    Vector6 above = below;
    above[3] += 2e-12;
    EXPECT_LT((leftJacobian(below) - leftJacobian(above)).norm(), 2e-11);
    EXPECT_LT((leftJacobianInverse(below) - leftJacobianInverse(above)).norm(), 2e-11);
}

TEST(Se3, LeftJacobianInverseInverts) {
    for (const Vector6& xi : twistSweep()) {
        const Matrix6 product = leftJacobian(xi) * leftJacobianInverse(xi);
        EXPECT_LT((product - Matrix6::Identity()).norm(), 3e-14);
    }
}

TEST(VispBridge, RoundTrips) {
    const Pose T = expSE3(twistSweep()[250]);
    EXPECT_EQ(fromVisp(toVisp(T)).matrix(), T.matrix());
    const Vector6 xi = Vector6::LinSpaced(1., 6.);
    EXPECT_EQ(twistFromVisp(toVisp(xi)), xi);
    const Matrix6 m = Matrix6(Eigen::VectorXd::LinSpaced(36, 1., 36.).reshaped(6, 6));
    EXPECT_EQ(matrix6FromVisp(toVisp(m)), m);
    EXPECT_EQ(toVisp(m)[1][4], m(1, 4));
}

TEST(Interpolation, IsStraightAndTurnsTheShorterWay) {
    Pose a = Pose::Identity();
    a.rotate(Eigen::AngleAxisd(3., Eigen::Vector3d::UnitZ()));
    Pose b = Pose::Identity();
    b.translation() << 1., 2., -4.;
    b.rotate(Eigen::AngleAxisd(-3., Eigen::Vector3d::UnitZ()));
    EXPECT_TRUE(interpolate(a, b, 0.).isApprox(a, 1e-12));
    EXPECT_TRUE(interpolate(a, b, 1.).isApprox(b, 1e-12));
    const Pose half = interpolate(a, b, 0.5);
    EXPECT_TRUE(half.translation().isApprox(Eigen::Vector3d(0.5, 1., -2.), 1e-12));
    EXPECT_NEAR(std::abs(yawOf(half)), std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace photonav
