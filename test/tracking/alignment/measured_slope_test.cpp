// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/measured_slope.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

using Slope = Eigen::Matrix<double, 40, 6>;

/// An image of 40 pixels that says J of itself and changes by D.
class MeasuredSlope : public testing::Test {
  protected:
    MeasuredSlope() {
        std::normal_distribution<double> normal;
        for (double& value : J.reshaped()) value = 100. * normal(random);
    }

    Matrix6 informationOf(const Slope& D, const TrustOptions& trust = {}) {
        const Matrix6 M = measuredSlope(prior, trust, [&](const Pose& T_away_here) {
            ++walks;
            NormalEquations e;
            e.AtA.topLeftCorner<6, 6>() = J.transpose() * J;
            e.count = walks == 1 ? 40. : 40. * inView;
            e.Atr.head<6>() = -(e.count / 40.) * J.transpose() * (D * logSE3(T_away_here));
            e.meanInverseDepth = 0.5;
            return e;
        });
        return M.transpose() * J.transpose() * J * M;
    }

    void expectClose(const Matrix6& a, const Matrix6& b) {
        EXPECT_LT((a - b).norm(), 0.01 * b.norm()) << a << "\n\n" << b;
    }

    std::mt19937_64 random{1};
    Slope J;
    Matrix6 prior = 0.01 * Matrix6::Identity();
    double inView = 1.;  // after a walk
    int walks = 0;
};

TEST_F(MeasuredSlope, IsJWhereJIsTrue) {
    expectClose(informationOf(J), J.transpose() * J);
    EXPECT_EQ(walks, 13);
}

/// D^T J (J^T J)^-1 J^T D: what the image does that J does not say is lost.
TEST_F(MeasuredSlope, IsTheSandwich) {
    Slope D = 0.6 * J;
    for (double& value : D.reshaped()) value += std::normal_distribution<double>(0., 5.)(random);
    const Matrix6 JtD = J.transpose() * D;
    expectClose(informationOf(D), JtD.transpose() * (J.transpose() * J).inverse() * JtD);
}

/// J says something along n, where nothing changes; what it says aside is true.
TEST_F(MeasuredSlope, InformsOfNothingWhereNothingChanges) {
    const Vector6 n = (Vector6() << 1., -0.5, 0.3, 0.2, 0.1, -0.7).finished().normalized();
    const Vector6 Jn = J.transpose() * (J * n);
    const Slope D = J * (Matrix6::Identity() - n * Jn.transpose() / n.dot(Jn));
    const Matrix6 information = informationOf(D);
    EXPECT_LT(n.dot(information * n), 0.01 * n.dot(Jn));
    expectClose(information, D.transpose() * D);
}

/// Two slopes may be steeper together than each alone.
TEST_F(MeasuredSlope, InformsOfNoDirectionMoreThanJ) {
    Slope D = J;
    for (double& value : D.reshaped()) value += std::normal_distribution<double>(0., 60.)(random);
    const Matrix6 information = informationOf(D);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(information, J.transpose() * J);
    EXPECT_LT(solver.eigenvalues().maxCoeff(), 1. + 1e-9);
    EXPECT_GT(solver.eigenvalues().minCoeff(), 0.1);
}

TEST_F(MeasuredSlope, IsLimitedToJ) { expectClose(informationOf(2. * J), J.transpose() * J); }

TEST_F(MeasuredSlope, DirectionsThatThePriorOrTheLeastSigmaDeterminesAreNotMeasured) {
    prior *= 1e-8;
    expectClose(informationOf(0.5 * J), J.transpose() * J);
    EXPECT_EQ(walks, 1);
    prior = 0.01 * Matrix6::Identity();
    expectClose(informationOf(0.5 * J, {.leastSigma = 0.1, .leastSigmaRotation = 0.1}),
                J.transpose() * J);
    EXPECT_EQ(walks, 2);
}

/// What leaves the image on the way has not changed; where too much does, nothing is measured.
TEST_F(MeasuredSlope, IsOfWhatStaysInView) {
    inView = 0.9;
    expectClose(informationOf(0.5 * J), 0.25 * J.transpose() * J);
    inView = 0.7;
    walks = 0;
    expectClose(informationOf(0.5 * J), J.transpose() * J);
    EXPECT_EQ(walks, 13);
}

}  // namespace
}  // namespace photonav
