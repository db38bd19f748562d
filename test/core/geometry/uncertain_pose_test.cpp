// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/uncertain_pose.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr int kSamples = 4000;
#else
constexpr int kSamples = 100000;
#endif

/// The 6x6 matrix of the Lie bracket: (ad(x) y)^ = x^ y^ - y^ x^.
Matrix6 bracket(const Vector6& x) {
    Matrix6 m = Matrix6::Zero();
    m.topLeftCorner<3, 3>() = hat(x.tail<3>());
    m.bottomRightCorner<3, 3>() = hat(x.tail<3>());
    m.topRightCorner<3, 3>() = hat(x.head<3>());
    return m;
}

Matrix6 randomCovariance(double rhoSigma, double phiSigma) {
    const Vector6 scale =
        (Vector6() << Eigen::Vector3d::Constant(rhoSigma), Eigen::Vector3d::Constant(phiSigma))
            .finished();
    const Matrix6 root = scale.asDiagonal() * Matrix6::Random();
    return root * root.transpose();
}

Pose randomPose() { return expSE3(3. * Vector6::Random()); }

bool sameCovariance(const Matrix6& a, const Matrix6& b, double tolerance) {
    return (a - b).norm() <= tolerance * b.norm();
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

// --- Monte Carlo on the paper's two examples --------------------------------------------------

struct Example {
    Pose start = Pose::Identity();
    Pose motion = Pose::Identity();
    Matrix6 noise = Matrix6::Zero();
};

/// 1 m along x, uncertain in yaw only.
Example planarExample() {
    Example e;
    e.motion.translation() << 1., 0., 0.;
    e.noise(5, 5) = 0.03;
    return e;
}

/// A helix: 1 m forward, 0.1 m up, uncertain in everything.
Example spatialExample() {
    Example e;
    e.start = expSE3(Vector6::Unit(5) * std::numbers::pi / 8.);
    e.motion.translation() << 1., 0., 0.1;
    e.noise.diagonal() << 0.01, 0.01, 0.01, 0.001, 0.001, 0.03;
    return e;
}

/// On which side a new motion enters: T_k+1,w = T_k+1,k T_k,w (ours) or T_w,k+1 = T_w,k T_k,k+1
/// (the paper's). Both perturb on the left.
enum class Side { motionLeft, motionRight };

/// Unguarded, so that the orders can be compared where the guard would step in.
Matrix6 propagate(const Example& e, int motions, PropagationOrder order, Side side) {
    UncertainPose T{e.start, Matrix6::Zero()};
    const UncertainPose step{e.motion, e.noise};
    for (int i = 0; i < motions; ++i) {
        const UncertainPose& left = side == Side::motionLeft ? step : T;
        const UncertainPose& right = side == Side::motionLeft ? T : step;
        const Matrix6 Ad = adjoint(left.mean);
        const Matrix6 carried = Ad * right.covariance * Ad.transpose();
        Matrix6 sum = left.covariance + carried;
        if (order == PropagationOrder::fourth) sum += fourthOrderTerms(left.covariance, carried);
        T = {left.mean * right.mean, sum};
    }
    return T.covariance;
}

/// Sample covariances of start motion^n after each of the ascending `checkpoints`. Motions are
/// independent and equally distributed, so their order does not matter; the start is exact and only
/// turns the result when it stands on the left.
std::vector<Matrix6> sample(const Example& e, const std::vector<int>& checkpoints, Side side) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    const Vector6 sigma = e.noise.diagonal().cwiseSqrt();
    std::vector<Pose> meanInverse;
    for (int n : checkpoints) {
        Pose mean = Pose::Identity();
        for (int i = 0; i < n; ++i) mean = mean * e.motion;
        meanInverse.push_back(mean.inverse());
    }
    std::vector<Matrix6> covariance(checkpoints.size(), Matrix6::Zero());
    for (int s = 0; s < kSamples; ++s) {
        Pose T = Pose::Identity();
        int done = 0;
        for (std::size_t c = 0; c < checkpoints.size(); ++c) {
            for (; done < checkpoints[c]; ++done) {
                Vector6 xi = Vector6::Zero();
                for (int i = 0; i < 6; ++i) {
                    if (sigma[i] > 0.) xi[i] = sigma[i] * normal(random);
                }
                T = T * (expSE3(xi) * e.motion);
            }
            const Vector6 xi = logSE3(T * meanInverse[c]);
            covariance[c] += xi * xi.transpose() / kSamples;
        }
    }
    const Matrix6 Ad = side == Side::motionRight ? adjoint(e.start) : Matrix6(Matrix6::Identity());
    for (Matrix6& c : covariance) c = (Ad * c * Ad.transpose()).eval();
    return covariance;
}

struct Errors {
    double second, fourth, traceSecond, traceFourth;
};

Errors errors(const Example& e, int motions, Side side, const Matrix6& truth) {
    const Matrix6 second = propagate(e, motions, PropagationOrder::second, side) - truth;
    const Matrix6 fourth = propagate(e, motions, PropagationOrder::fourth, side) - truth;
    return {second.norm(), fourth.norm(), std::abs(second.trace()), std::abs(fourth.trace())};
}

/// What both examples show: fourth order is several times better up to about 1 rad of accumulated
/// yaw, still better in the Frobenius norm at 1.7 rad, but worse in trace there.
void expectFourthOrderGains(const Example& e, Side side) {
    const std::vector<Matrix6> truth = sample(e, {10, 30, 100}, side);
    const Errors near = errors(e, 10, side, truth[0]);
    const Errors middle = errors(e, 30, side, truth[1]);
    const Errors far = errors(e, 100, side, truth[2]);
    if (kSamples >= 100000) {  // fewer cannot tell them apart
        EXPECT_LT(near.fourth, 0.4 * near.second);
    }
    EXPECT_LT(middle.fourth, 0.5 * middle.second);
    EXPECT_LT(middle.traceFourth, 0.8 * middle.traceSecond);
    EXPECT_LT(far.fourth, 0.65 * far.second);
    EXPECT_GT(far.traceFourth, far.traceSecond);
}

TEST(MonteCarlo, PlanarExampleOurCompounding) {
    expectFourthOrderGains(planarExample(), Side::motionLeft);
}

TEST(MonteCarlo, SpatialExampleThePapersCompounding) {
    expectFourthOrderGains(spatialExample(), Side::motionRight);
}

TEST(MonteCarlo, BothSidesGiveTheSameCovarianceUpToTheStart) {
    const Example e = spatialExample();
    const Matrix6 Ad = adjoint(e.start);
    for (PropagationOrder order : {PropagationOrder::second, PropagationOrder::fourth}) {
        const Matrix6 left = propagate(e, 5, order, Side::motionLeft);
        const Matrix6 right = propagate(e, 5, order, Side::motionRight);
        EXPECT_TRUE(sameCovariance(Ad * left * Ad.transpose(), right, 1e-2));
    }
}

/// Noise so large that what second order leaves out stands out from sampling: over seeds, the ratio
/// is 0.13 to 0.27 with 20000 samples and 0.06 to 0.21 with five times as many.
TEST(MonteCarlo, CompoundOfTwoFullCovariances) {
    constexpr int kPairs = 50000;
    std::srand(2);
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    const UncertainPose T_c_b{randomPose(), randomCovariance(0.2, 0.3)};
    const UncertainPose T_b_a{randomPose(), randomCovariance(0.3, 0.3)};
    const Matrix6 root1 = T_c_b.covariance.llt().matrixL();
    const Matrix6 root2 = T_b_a.covariance.llt().matrixL();
    const Pose meanInverse = (T_c_b.mean * T_b_a.mean).inverse();
    Matrix6 truth = Matrix6::Zero();
    for (int s = 0; s < kPairs; ++s) {
        const auto draw = [&](const Matrix6& root) {
            return Vector6(root * Vector6::NullaryExpr([&]() { return normal(random); }));
        };
        const Pose T = expSE3(draw(root1)) * T_c_b.mean * expSE3(draw(root2)) * T_b_a.mean;
        const Vector6 xi = logSE3(T * meanInverse);
        truth += xi * xi.transpose();
    }
    truth /= kPairs;
    const Matrix6 second = compound(T_c_b, T_b_a, PropagationOrder::second).covariance;
    const Matrix6 fourth = compound(T_c_b, T_b_a, PropagationOrder::fourth).covariance;
    EXPECT_LT((fourth - truth).norm(), 0.5 * (second - truth).norm());
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

TEST(Compound, NothingUncertainStaysCertain) {
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
