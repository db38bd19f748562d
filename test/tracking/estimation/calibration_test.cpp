// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/calibration.hpp"

#include <gtest/gtest.h>

#include <random>

#include "alignment/residual_covariance.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

/// Errors whose covariance is (scale * information)^-1 or that of the least sigmas, whichever is
/// larger.
std::vector<AlignmentError> sampled(double scale, double leastSigma, double leastSigmaRotation,
                                    int count) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::vector<AlignmentError> errors;
    for (int i = 0; i < count; ++i) {
        Vector6 sigmas;
        sigmas << 0.001, 0.03, 0.002, 0.0005, 0.01, 0.002;
        AlignmentError e;
        e.information = sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
        const Matrix6 covariance =
            withLeastSigma((scale * e.information).inverse(), leastSigma, leastSigmaRotation);
        Vector6 z;
        for (double& component : z) component = normal(random);
        e.xi = covariance.llt().matrixL() * z;
        errors.push_back(e);
    }
    return errors;
}

/// Errors of motions of some decimetres, of which depth gets a share wrong; the information counts
/// another share.
std::vector<AlignmentError> withDepthError(double share, double counted, int count) {
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    std::vector<AlignmentError> errors = sampled(1., 0., 0., count);
    for (AlignmentError& e : errors) {
        Vector6 motion, z;
        for (int i = 0; i < 6; ++i) motion[i] = (i < 3 ? 0.3 : 0.1) * normal(random);
        for (double& component : z) component = normal(random);
        e.sinceKeyframe = expSE3(motion);
        e.xi += covarianceByScale(share, e.sinceKeyframe).cwiseSqrt() * z;
        e.information =
            (e.information.inverse() + covarianceByScale(counted, e.sinceKeyframe)).inverse();
    }
    return errors;
}

TEST(Calibration, FindsTheErrorOfDepth) {
    for (const double counted : {0., 0.03, 0.1}) {
        EXPECT_NEAR(calibrateDepthError(withDepthError(0.05, counted, 200), counted).value(), 0.05,
                    0.005);
        EXPECT_LT(calibrateDepthError(withDepthError(0., counted, 200), counted).value(), 0.005);
    }
    EXPECT_THROW(calibrateDepthError({}, 0.), std::invalid_argument);
    EXPECT_FALSE(calibrateDepthError(withDepthError(0.05, 0.03, 200), 5.)) << "never counted";
}

TEST(Calibration, LeavesConsistentErrorsAlone) {
    const auto errors = sampled(1., 0., 0., 400);
    const Calibration c = calibrate(errors);
    EXPECT_NEAR(c.neesBefore, 1., 0.1);
    EXPECT_NEAR(c.scale, 1., 0.1);
    EXPECT_EQ(c.leastSigma, 0.);
    EXPECT_EQ(c.leastSigmaRotation, 0.);
}

TEST(Calibration, FindsAScale) {
    const Calibration c = calibrate(sampled(0.05, 0., 0., 400));
    EXPECT_NEAR(c.neesBefore, 20., 2.);
    EXPECT_NEAR(c.scale, 0.05, 0.005);
    EXPECT_EQ(c.leastSigma, 0.);
    EXPECT_NEAR(c.neesAfter, 1., 1e-6);
}

TEST(Calibration, FindsAScaleAndLeastSigmas) {
    const Calibration c = calibrate(sampled(0.5, 0.01, 0.004, 400));
    EXPECT_NEAR(c.scale, 0.5, 0.1);
    EXPECT_NEAR(c.leastSigma, 0.01, 0.001);
    EXPECT_NEAR(c.leastSigmaRotation, 0.004, 0.0004);
    EXPECT_NEAR(c.neesAfter, 1., 0.1);
}

TEST(Calibration, MeasuresTheCorrelationTimeOfErrors) {
    EXPECT_NEAR(calibrate(sampled(1., 0., 0., 1000)).correlationTime, 1., 0.3);
    std::vector<AlignmentError> errors = sampled(1., 0., 0., 4000);
    constexpr double kRho = 0.8;  // AR(1): (1 + rho) / (1 - rho) = 9
    for (std::size_t i = 1; i < errors.size(); ++i) {
        errors[i].xi = kRho * errors[i - 1].xi + std::sqrt(1. - kRho * kRho) * errors[i].xi;
    }
    const Calibration c = calibrate(errors);
    EXPECT_NEAR(c.correlationTime, 9., 1.5);
    EXPECT_NEAR(c.scale, 1., 0.1);
}

TEST(Calibration, OfLeastSigmasAloneKeepsTheScale) {
    const Calibration c = calibrateLeastSigma(sampled(0.5, 0.01, 0.004, 400), 0.5);
    EXPECT_EQ(c.scale, 0.5);
    EXPECT_NEAR(c.leastSigma, 0.01, 0.001);
    EXPECT_NEAR(c.leastSigmaRotation, 0.004, 0.0004);
    EXPECT_EQ(c.correlationTime, 1.);
    EXPECT_GT(c.neesBefore, 3.);
    EXPECT_NEAR(c.neesAfter, 1., 0.1);
    EXPECT_THROW(calibrateLeastSigma(sampled(1., 0., 0., 10), 1.), std::invalid_argument);
}

TEST(Calibration, WantsEnoughErrors) {
    EXPECT_THROW(calibrate(sampled(1., 0., 0., 10)), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
