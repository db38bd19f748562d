// SPDX-License-Identifier: BSD-3-Clause
#include "flight/arrival.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/camera.hpp"
#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

PositionBelief round(double sigma) {
    return {Vector3d::Zero(), sigma * sigma * Eigen::Matrix3d::Identity()};
}

/// Of three degrees of freedom: P(|x| < r) = erf(a / sqrt 2) - sqrt(2 / pi) a exp(-a^2 / 2).
TEST(Arrival, ProbabilityOfABallIsThatOfChiSquare) {
    for (const double a : {0.5, 1., 2., 3.}) {
        const double exact =
            std::erf(a / std::sqrt(2.)) - std::sqrt(2. / M_PI) * a * std::exp(-0.5 * a * a);
        EXPECT_NEAR(probabilityWithin(round(0.1), Vector3d::Zero(), 0.1 * a), exact, 0.01) << a;
    }
}

TEST(Arrival, ProbabilityFallsWithOffsetAndWidth) {
    EXPECT_EQ(probabilityWithin(round(0.), Vector3d(0.2, 0., 0.), 0.3), 1.);
    EXPECT_EQ(probabilityWithin(round(0.), Vector3d(0.4, 0., 0.), 0.3), 0.);
    EXPECT_GT(probabilityWithin(round(0.08), Vector3d::Zero(), 0.3), kArrivalConfidence);
    EXPECT_LT(probabilityWithin(round(0.08), Vector3d(0.2, 0., 0.), 0.3), kArrivalConfidence);
    EXPECT_LT(probabilityWithin(round(0.12), Vector3d::Zero(), 0.3), kArrivalConfidence);
    PositionBelief along = round(0.01);
    along.covariance(1, 1) = 0.25;  // one direction is enough
    EXPECT_NEAR(probabilityWithin(along, Vector3d::Zero(), 0.3), std::erf(0.6 / std::sqrt(2.)),
                0.01);
}

TEST(Arrival, PositionOfTheBodyFollowsFromTheCamerasBelief) {
    const Pose T_b_c = Eigen::Translation3d(0.3, 0., -0.1) * cameraMount(0.8);
    std::mt19937_64 random(3);
    Vector6 variances;
    variances << 1e-2, 4e-2, 1e-3, 1e-2, 1e-4, 2e-3;
    Matrix6 correlated = Matrix6::Identity();
    correlated.bottomLeftCorner<3, 3>().setConstant(0.5);  // rotations with translations
    const Matrix6 spread = variances.cwiseSqrt().asDiagonal() * correlated;
    const UncertainPose T_c_w{expSE3(draw(Matrix6::Identity(), random)),
                              spread * spread.transpose()};
    const PositionBelief position = bodyPosition(T_c_w, T_b_c);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    const Matrix6 root = rootOf(1e-2 * T_c_w.covariance);  // small: to first order
    for (int i = 0; i < 20000; ++i) {
        const Pose T = expSE3(draw(root, random)) * T_c_w.mean;
        const Vector3d e = (T_b_c * T).inverse().translation() - position.mean_w;
        sum += e * e.transpose() / (1e-2 * 20000);
    }
    EXPECT_TRUE(position.covariance.isApprox(sum, 0.05)) << position.covariance << "\n\n" << sum;
}

/// Draws a truth from the prior and an image's estimate of two directions.
double meanSquaredCorrection(double trueVariance, int samples) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const Matrix6 prior = 0.04 * Matrix6::Identity();
    Matrix6 information = Matrix6::Zero();
    information.topLeftCorner<2, 2>() = 100. * Eigen::Matrix2d::Identity();
    const Matrix6 posterior = updateCovariance(prior, information);
    double sum = 0.;
    for (int i = 0; i < samples; ++i) {
        Vector6 step = Vector6::Zero();
        for (int k = 0; k < 2; ++k) {
            const double measured = std::sqrt(trueVariance) * normal(random) + 0.1 * normal(random);
            step[k] = posterior(k, k) * 100. * measured;
        }
        sum += squaredCorrection({Pose::Identity(), prior}, {expSE3(step), posterior}).value();
    }
    return sum / samples;
}

TEST(Corrections, AreOneOnAverageWhereThePriorIsConsistent) {
    EXPECT_NEAR(meanSquaredCorrection(0.04, 2000), 1., 0.08);
    EXPECT_GT(meanSquaredCorrection(0.4, 500), 5.);
}

TrackedFrame tracked(const UncertainPose& prior, const UncertainPose& posterior) {
    TrackedFrame frame;
    frame.predicted = prior;
    frame.T_c_w = posterior;
    return frame;
}

TEST(Corrections, AreNotCountedWithoutInformation) {
    const UncertainPose belief{Pose::Identity(), 0.04 * Matrix6::Identity()};
    EXPECT_FALSE(squaredCorrection(belief, belief));
    EXPECT_FALSE(squaredCorrection({Pose::Identity(), Matrix6::Zero()}, belief));
    Corrections corrections;
    corrections.add(tracked(belief, belief));
    EXPECT_EQ(corrections.varianceFactor(), 1.);
}

TEST(Corrections, WidenABeliefAsLongAsTheyAreTooLarge) {
    const UncertainPose prior{Pose::Identity(), 0.04 * Matrix6::Identity()};
    Vector6 far = Vector6::Zero();
    far[0] = 2.;
    const Matrix6 posterior = 1e-4 * Matrix6::Identity();
    Corrections corrections;
    TrackedFrame rejected = tracked(prior, {expSE3(far), posterior});
    rejected.rejected = true;
    corrections.add(rejected);
    EXPECT_EQ(corrections.varianceFactor(), 1.);
    corrections.add(tracked(prior, {expSE3(far), posterior}));
    EXPECT_NEAR(corrections.varianceFactor(), 100. / 6., 0.1);
    for (int i = 0; i < 9; ++i) corrections.add(tracked(prior, {Pose::Identity(), posterior}));
    EXPECT_NEAR(corrections.varianceFactor(), 10. / 6., 0.1);
    corrections.add(tracked(prior, {Pose::Identity(), posterior}));
    EXPECT_EQ(corrections.varianceFactor(), 1.);
}

}  // namespace
}  // namespace photonav
