// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/measured_motion.hpp"

#include <gtest/gtest.h>

#include <random>

#include "estimation/motion_model.hpp"

namespace photonav {
namespace {

/// A step of the body along its x axis, with a variance along it.
UncertainPose step(double length, double variance) {
    UncertainPose T_next_now;
    T_next_now.mean.translation() = Eigen::Vector3d(-length, 0., 0.);
    T_next_now.covariance(0, 0) = variance;
    return T_next_now;
}

/// Distance of a camera's motion along its z axis, with the variance.
void expectForward(const UncertainPose& motion, double length, double variance) {
    EXPECT_NEAR(motion.mean.translation().z(), -length, 1e-12);
    EXPECT_NEAR(motion.covariance(2, 2), variance, 1e-12);
    EXPECT_NEAR(motion.covariance.trace(), variance, 1e-12);
}

TEST(MeasuredMotion, IsTakenUntilAnExposureAndKeptAfterIt) {
    Pose T_b_c = Pose::Identity();  // the camera looks along the body's x axis
    T_b_c.linear().col(0) = -Eigen::Vector3d::UnitY();
    T_b_c.linear().col(1) = -Eigen::Vector3d::UnitZ();
    T_b_c.linear().col(2) = Eigen::Vector3d::UnitX();
    MeasuredMotion motion(T_b_c);
    motion.add(0.1, step(0.1, 1e-4));
    motion.add(0.2, step(0.2, 2e-4));
    motion.add(0.3, step(0.4, 4e-4));
    expectForward(motion.pending(), 0.7, 7e-4);
    expectForward(motion.takeUntil(0.2), 0.3, 3e-4);  // the step that ends at the exposure, too
    expectForward(motion.pending(), 0.4, 4e-4);
    expectForward(motion.takeUntil(0.2), 0., 0.);
    motion.add(0.4, step(0.8, 8e-4));
    expectForward(motion.pending(), 1.2, 12e-4);
    expectForward(motion.takeUntil(1.), 1.2, 12e-4);
    expectForward(motion.pending(), 0., 0.);
}

TEST(MeasuredMotion, IsDividedAtAnExposureWithinAStep) {
    MeasuredMotion motion(Pose::Identity());
    Vector6 xi;
    xi << 0.04, -0.02, 0.01, 0.02, 0.1, -0.05;
    const UncertainPose T_next_now{expSE3(xi), 1e-4 * Matrix6::Identity()};
    motion.add(0.1, T_next_now);
    motion.add(0.2, T_next_now);
    const UncertainPose first = motion.takeUntil(0.175);
    EXPECT_LT((logSE3(first.mean) - 1.75 * xi).norm(), 1e-12);
    EXPECT_NEAR(first.covariance(5, 5), 1.75e-4, 1e-7);
    EXPECT_LT((logSE3(motion.pending().mean) - 0.25 * xi).norm(), 1e-12);
    EXPECT_NEAR(motion.pending().covariance(5, 5), 0.25e-4, 1e-9);
    const UncertainPose second = motion.takeUntil(0.19);  // the same step once more
    EXPECT_LT((logSE3(second.mean) - 0.15 * xi).norm(), 1e-12);
    EXPECT_LT((logSE3(motion.takeUntil(0.2).mean) - 0.1 * xi).norm(), 1e-12);
}

/// When it began is not known.
TEST(MeasuredMotion, TheFirstStepIsNotDivided) {
    MeasuredMotion motion(Pose::Identity());
    motion.add(0.1, step(0.1, 1e-4));
    EXPECT_EQ(motion.takeUntil(0.05).mean.translation().norm(), 0.);
    EXPECT_NEAR(motion.takeUntil(0.1).mean.translation().norm(), 0.1, 1e-12);
}

TEST(MotionModel, GoesOnAtTheVelocityObservedLast) {
    MotionModel model({.speed = 0.5, .turn = 1.});
    Vector6 xi;
    xi << 0.1, 0., 0.2, 0., 0.05, 0.;
    model.observe({expSE3(xi), Matrix6::Zero()}, 0.5);
    const UncertainPose motion = model.predict(0.25);
    EXPECT_LT((logSE3(motion.mean) - 0.5 * xi).norm(), 1e-12);
    Vector6 variance;
    variance << Eigen::Vector3d::Constant(0.125 * 0.125), Eigen::Vector3d::Constant(0.0625);
    EXPECT_LT((motion.covariance.diagonal() - variance).norm(), 1e-12);
    model.observe({expSE3(2. * xi), Matrix6::Zero()}, 0.);  // two images of one time: no velocity
    EXPECT_LT((logSE3(model.predict(0.5).mean) - xi).norm(), 1e-12);
    EXPECT_TRUE(model.predict(-1.).mean.isApprox(Pose::Identity()));
    model.forget();
    EXPECT_TRUE(model.predict(0.5).mean.isApprox(Pose::Identity()));
}

TEST(MotionModel, IsAsUncertainAsTheMotionThatItGoesOn) {
    MotionModel model({.speed = 0.5, .turn = 1.});
    model.observe({Pose::Identity(), 0.04 * Matrix6::Identity()}, 0.5);
    const Vector6 variances = model.predict(0.5).covariance.diagonal();
    EXPECT_NEAR(variances[0], 0.0625 + 0.04, 1e-12);
    EXPECT_NEAR(variances[5], 0.25 + 0.04, 1e-12);
    model.forget();
    EXPECT_NEAR(model.predict(0.5).covariance(0, 0), 0.0625, 1e-12);
}

/// A pose x and a motion m lead to x + m, which is observed: the update of both.
TEST(MotionModel, AMotionIsUpdatedByThePoseThatItLedTo) {
    std::mt19937_64 random(4);
    const auto covariance = [&random](double scale) {
        const Matrix6 A =
            Matrix6::NullaryExpr([&random] { return std::normal_distribution<double>()(random); });
        return Matrix6(scale * A * A.transpose());
    };
    const Matrix6 before = covariance(1.), motion = covariance(2.), noise = covariance(0.5);
    Eigen::Matrix<double, 12, 12> both;
    both << before, Matrix6::Zero(), Matrix6::Zero(), motion;
    Eigen::Matrix<double, 6, 12> H;
    H << Matrix6::Identity(), Matrix6::Identity();
    const Matrix6 predicted = before + motion;
    const Eigen::Matrix<double, 12, 6> gain = both * H.transpose() * (predicted + noise).inverse();
    const Eigen::Matrix<double, 12, 12> updated = both - gain * H * both;
    const Matrix6 observed = H * updated * H.transpose();
    const Matrix6 expected = updated.bottomRightCorner<6, 6>();
    // The means by small translations, for which SE(3) is a vector space.
    Vector6 found;
    found << 1e-3, -2e-3, 3e-3, 0., 0., 0.;
    const Vector6 correction = predicted * (predicted + noise).inverse() * found;
    const Vector6 ofMotion = (gain * found).tail<6>();
    const UncertainPose after = motionAfter(
        {Pose::Identity(), motion}, {Pose::Identity(), predicted}, {expSE3(correction), observed});
    EXPECT_LT((after.covariance - expected).norm(), 1e-9);
    EXPECT_LT((logSE3(after.mean) - ofMotion).norm(), 0.02 * ofMotion.norm());
    const UncertainPose same = motionAfter(
        {Pose::Identity(), motion}, {Pose::Identity(), predicted}, {Pose::Identity(), predicted});
    EXPECT_LT((same.covariance - motion).norm(), 1e-9);
    EXPECT_TRUE(same.mean.isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace photonav
