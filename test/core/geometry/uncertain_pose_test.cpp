// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/uncertain_pose.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/geometry/random_poses.hpp"

namespace photonav {
namespace {

using test::randomCovariance;
using test::randomPose;
using test::sameCovariance;

/// The 6x6 matrix of the Lie bracket: (ad(x) y)^ = x^ y^ - y^ x^.
Matrix6 bracket(const Vector6& x) {
    Matrix6 m = Matrix6::Zero();
    m.topLeftCorner<3, 3>() = hat(x.tail<3>());
    m.bottomRightCorner<3, 3>() = hat(x.tail<3>());
    m.topRightCorner<3, 3>() = hat(x.head<3>());
    return m;
}

// --- The fourth-order terms -----------------------------------------------------------------

/// BF14's B = E[ad(x1) S2 ad(x1)^T] and A = E[ad(x) ad(x)] as sums over the elements of S1: no
/// <<A, B>> notation involved, hence none of its misprints.
Matrix6 fourthOrderTermsByExpectation(const Matrix6& S1, const Matrix6& S2) {
    Matrix6 A1 = Matrix6::Zero();
    Matrix6 A2 = Matrix6::Zero();
    Matrix6 B = Matrix6::Zero();
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            const Matrix6 left = bracket(Vector6::Unit(i));
            const Matrix6 right = bracket(Vector6::Unit(j));
            A1 += S1(i, j) * left * right;
            A2 += S2(i, j) * left * right;
            B += S1(i, j) * left * S2 * right.transpose();
        }
    }
    return B / 4. + (A1 * S2 + S2 * A1.transpose() + A2 * S1 + S1 * A2.transpose()) / 12.;
}

TEST(FourthOrder, TermsAreBarfootAndFurgales) {
    std::srand(1);
    for (int i = 0; i < 50; ++i) {
        const Matrix6 S1 = randomCovariance(1., 0.1);
        const Matrix6 S2 = randomCovariance(0.3, 0.2);
        EXPECT_TRUE(
            sameCovariance(fourthOrderTerms(S1, S2), fourthOrderTermsByExpectation(S1, S2), 1e-13));
    }
}

// --- Compounding and its guard ----------------------------------------------------------------

TEST(Compound, SecondOrderIsTheAdjointSandwich) {
    std::srand(3);
    for (int i = 0; i < 50; ++i) {
        const Matrix6 Ad = adjoint(randomPose());
        const Matrix6 motion = randomCovariance(0.1, 0.05);
        const Matrix6 prior = randomCovariance(0.5, 0.1);
        const Matrix6 expected = motion + Ad * prior * Ad.transpose();
        const auto result = compoundCovariance(Ad, motion, prior, PropagationOrder::second);
        EXPECT_TRUE(sameCovariance(result.covariance, expected, 1e-14));
        EXPECT_TRUE(isCovariance(result.covariance));
        EXPECT_FALSE(result.fellBack);
    }
}

TEST(Compound, FourthOrderAddsItsTerms) {
    std::srand(4);
    const Matrix6 Ad = adjoint(randomPose());
    const Matrix6 motion = randomCovariance(0.1, 0.05);
    const Matrix6 prior = randomCovariance(0.5, 0.1);
    const Matrix6 carried = Ad * prior * Ad.transpose();
    const auto result = compoundCovariance(Ad, motion, prior, PropagationOrder::fourth);
    EXPECT_FALSE(result.fellBack);
    EXPECT_TRUE(sameCovariance(result.covariance,
                               motion + carried + fourthOrderTerms(motion, carried), 1e-14));
}

TEST(Compound, CertainPosesStayCertain) {
    const auto result = compoundCovariance(adjoint(randomPose()), Matrix6::Zero(), Matrix6::Zero(),
                                           PropagationOrder::fourth);
    EXPECT_EQ(result.covariance, Matrix6::Zero());
    EXPECT_FALSE(result.fellBack);
}

TEST(Guard, FallsBackWhereTheRotationIsTooUncertain) {
    Matrix6 motion = Matrix6::Zero();
    motion(5, 5) = std::pow(0.99 * kFourthOrderMaxRotationSigma, 2);
    Matrix6 prior = Matrix6::Identity() * 1e-4;
    const auto below =
        compoundCovariance(Matrix6::Identity(), motion, prior, PropagationOrder::fourth);
    EXPECT_FALSE(below.fellBack);
    EXPECT_FALSE(sameCovariance(below.covariance, motion + prior, 1e-6));
    motion(5, 5) = std::pow(1.01 * kFourthOrderMaxRotationSigma, 2);
    for (bool swapped : {false, true}) {
        const auto above = compoundCovariance(Matrix6::Identity(), swapped ? prior : motion,
                                              swapped ? motion : prior, PropagationOrder::fourth);
        EXPECT_TRUE(above.fellBack);
        EXPECT_TRUE(sameCovariance(above.covariance, motion + prior, 1e-15));
    }
}

/// A thin covariance next to a correlated one: the A terms, linear in the thin one, outweigh it.
TEST(Guard, FallsBackWhereTheSumWouldBeIndefinite) {
    std::srand(5);
    int indefinite = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vector6 a = 0.28 * Vector6::Random();
        const Vector6 b = 0.28 * Vector6::Random();
        const Matrix6 motion = a * a.transpose();
        const Matrix6 prior = b * b.transpose();
        const auto result =
            compoundCovariance(Matrix6::Identity(), motion, prior, PropagationOrder::fourth);
        const Matrix6 fourth = motion + prior + fourthOrderTerms(motion, prior);
        const double least = fourth.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
        if (least < -1e-9) {
            ++indefinite;
            EXPECT_TRUE(result.fellBack);
        }
        EXPECT_GT(result.covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(),
                  -1e-10);
        EXPECT_TRUE(isCovariance(result.covariance));
    }
    EXPECT_GT(indefinite, 100) << "the case does not test the guard";
}

TEST(Compound, TraceDoesNotDependOnTheWorldOrigin) {
    std::srand(6);
    const UncertainPose motion{expSE3(0.2 * Vector6::Random()), randomCovariance(0.1, 0.02)};
    UncertainPose near{randomPose(), randomCovariance(0.2, 0.05)};
    UncertainPose far = near;
    far.mean.translation() += far.mean.linear() * Eigen::Vector3d(1000., -500., 20.);
    for (int i = 0; i < 20; ++i) {
        near = compound(motion, near);
        far = compound(motion, far);
    }
    EXPECT_NEAR(near.covariance.trace(), far.covariance.trace(), 1e-12 * near.covariance.trace());
}

// --- Inverse ----------------------------------------------------------------------------------

TEST(OtherFrame, IsTheAdjointSandwichAndSymmetric) {
    std::srand(9);
    for (int i = 0; i < 20; ++i) {
        const Matrix6 covariance = randomCovariance(1., 0.1);
        const Pose T_b_a = randomPose();
        const Matrix6 inB = inOtherFrame(covariance, T_b_a);
        EXPECT_EQ(inB, inB.transpose());
        const Matrix6 Ad = adjoint(T_b_a);
        EXPECT_TRUE(sameCovariance(inB, Ad * covariance * Ad.transpose(), 1e-12));
        EXPECT_TRUE(sameCovariance(inOtherFrame(inB, T_b_a.inverse()), covariance, 1e-9));
    }
}

TEST(Inverse, CarriesTheSamePerturbation) {
    std::srand(7);
    const UncertainPose T_b_a{randomPose(), randomCovariance(0.1, 0.05)};
    const UncertainPose T_a_b = inverse(T_b_a);
    // (exp(xi^) T)^-1 = exp((-Ad(T^-1) xi)^) T^-1, exactly.
    const Vector6 xi = 0.3 * Vector6::Random();
    const Pose perturbed = (expSE3(xi) * T_b_a.mean).inverse();
    const Vector6 carried = logSE3(perturbed * T_a_b.mean.inverse());
    const Matrix6 Ad = adjoint(T_b_a.mean.inverse());
    EXPECT_LT((carried + Ad * xi).norm(), 1e-13);
    EXPECT_TRUE(sameCovariance(T_a_b.covariance, Ad * T_b_a.covariance * Ad.transpose(), 1e-14));
    EXPECT_TRUE(isCovariance(T_a_b.covariance));
    EXPECT_TRUE(sameCovariance(inverse(T_a_b).covariance, T_b_a.covariance, 1e-12));
    EXPECT_LT((inverse(T_a_b).mean.matrix() - T_b_a.mean.matrix()).norm(), 1e-14);
}

// --- Update -----------------------------------------------------------------------------------

/// (1 + Sigma Lambda)^-1 Sigma in extended precision.
Matrix6 updateReference(const Matrix6& covariance, const Matrix6& information) {
    using Wide = Eigen::Matrix<long double, 6, 6>;
    const Wide sigma = covariance.cast<long double>();
    const Wide system = Wide::Identity() + sigma * information.cast<long double>();
    return system.fullPivLu().solve(sigma).cast<double>();
}

TEST(Update, AgreesWithTheInverseFormWhereThatExists) {
    std::srand(8);
    const Matrix6 covariance = randomCovariance(0.1, 0.01);
    const Matrix6 information = randomCovariance(100., 100.);
    const Matrix6 expected = (information + covariance.inverse()).inverse();
    const Matrix6 updated = updateCovariance(covariance, information);
    EXPECT_TRUE(sameCovariance(updated, expected, 1e-10));
    EXPECT_EQ(updated, updated.transpose());
}

TEST(Update, WhiteFloorChangesNothing) {
    std::srand(9);
    const Matrix6 covariance = randomCovariance(0.1, 0.01);
    EXPECT_EQ(updateCovariance(covariance, Matrix6::Zero()), covariance);
    EXPECT_EQ(updateCovariance(Matrix6::Zero(), Matrix6::Zero()), Matrix6::Zero());
}

TEST(Update, CertaintyStaysCertain) {
    std::srand(10);
    EXPECT_EQ(updateCovariance(Matrix6::Zero(), randomCovariance(1e4, 1e4)), Matrix6::Zero());
    // Certain in some directions only: rank 3 by zeros.
    Matrix6 covariance = Matrix6::Zero();
    covariance.topLeftCorner<3, 3>() = randomCovariance(0.1, 0.1).topLeftCorner<3, 3>();
    const Matrix6 updated = updateCovariance(covariance, randomCovariance(1e3, 1e3));
    EXPECT_EQ((updated.bottomRows<3>()), (Matrix6::Zero().bottomRows<3>()));
    EXPECT_TRUE(isCovariance(updated));
}

TEST(Update, StripesLeaveTheirBlindDirectionsAlone) {
    std::srand(11);
    const Matrix6 covariance = randomCovariance(0.3, 0.05);
    const Eigen::Matrix<double, 3, 6> J = 1e3 * Eigen::Matrix<double, 3, 6>::Random();
    const Matrix6 information = J.transpose() * J;
    const Matrix6 updated = updateCovariance(covariance, information);
    EXPECT_TRUE(sameCovariance(updated, updateReference(covariance, information), 1e-10));
    EXPECT_TRUE(isCovariance(updated));
    // In information form the blind directions keep what they had.
    const Matrix6 blind = J.fullPivLu().kernel() * J.fullPivLu().kernel().transpose();
    const Matrix6 gained = blind * (updated.inverse() - covariance.inverse()) * blind;
    EXPECT_LT(gained.norm(), 1e-6 * (blind * covariance.inverse() * blind).norm());
}

TEST(Update, HoldsAcrossTwelveOrdersOfMagnitude) {
    std::srand(12);
    double worst = 0.;
    for (double information : {1e-6, 1., 1e3, 1e6, 1e9, 1e12}) {
        for (int i = 0; i < 50; ++i) {
            const Matrix6 covariance = randomCovariance(0.3, 0.3e-2);
            const Matrix6 lambda = information * randomCovariance(1., 1.);
            const Matrix6 expected = updateReference(covariance, lambda);
            const Matrix6 updated = updateCovariance(covariance, lambda);
            const double condition = lambda.norm() * lambda.inverse().norm();
            worst = std::max(worst, (updated - expected).norm() / expected.norm() / condition);
            EXPECT_TRUE(isCovariance(updated));
        }
    }
    EXPECT_LT(worst, 1e-11);
}

TEST(Update, GoesBothWaysInSmallSteps) {
    std::srand(13);
    const Matrix6 covariance = randomCovariance(0.3, 0.05);
    const Matrix6 information = randomCovariance(100., 100.);
    Matrix6 inSteps = covariance;
    for (int i = 0; i < 10; ++i) inSteps = updateCovariance(inSteps, 0.1 * information);
    EXPECT_TRUE(sameCovariance(inSteps, updateCovariance(covariance, information), 1e-10));
}

// --- Boundaries -------------------------------------------------------------------------------

TEST(IsCovariance, AcceptsCovariancesOnly) {
    std::srand(14);
    EXPECT_TRUE(isCovariance(Matrix6::Zero()));
    EXPECT_TRUE(isCovariance(randomCovariance(0.3, 1e-4)));
    Vector6 variances;
    variances << .115, .115, .038, 5e-6, 5e-6, 0.;
    EXPECT_TRUE(isCovariance(variances.asDiagonal()));

    variances[4] = -1e-9;  // small, but not beside 5e-6 rad^2
    EXPECT_FALSE(isCovariance(variances.asDiagonal()));
    Matrix6 asymmetric = Matrix6::Identity();
    asymmetric(0, 4) = 0.1;
    EXPECT_FALSE(isCovariance(asymmetric));
    Matrix6 indefinite = Matrix6::Identity();
    indefinite(0, 4) = indefinite(4, 0) = 1.01;
    EXPECT_FALSE(isCovariance(indefinite));
    Matrix6 broken = Matrix6::Identity();
    broken(2, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(isCovariance(broken));
    broken(2, 2) = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(isCovariance(broken));
    Matrix6 correlatedWithNothing = Matrix6::Identity();
    correlatedWithNothing(3, 3) = 0.;
    correlatedWithNothing(3, 0) = correlatedWithNothing(0, 3) = 1e-3;
    EXPECT_FALSE(isCovariance(correlatedWithNothing));
}

TEST(WeightedTrace, WeighsRotationsByTheSquaredLength) {
    const Matrix6 covariance = Vector6::LinSpaced(1., 6.).asDiagonal();
    EXPECT_DOUBLE_EQ(weightedTrace(covariance), 21.);
    EXPECT_DOUBLE_EQ(weightedTrace(covariance, 2.), 66.);
}

}  // namespace
}  // namespace photonav
