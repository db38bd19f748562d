// SPDX-License-Identifier: BSD-3-Clause
// Gain and offset of an image, estimated beside its pose.
#include <gtest/gtest.h>

#include "alignment/dense_aligner.hpp"
#include "alignment/residual_covariance.hpp"
#include "estimation/calibration.hpp"
#include "tracking/alignment/room_images.hpp"

namespace photonav {
namespace {

using test::camera;
using test::errorOf;
using test::kPose;
using test::observe;
using test::room;

TEST(Exposure, IsEstimated) {
    ImageF image = observe(room(), kPose, 0.01);
    for (unsigned i = 0; i < image.getSize(); ++i) image.bitmap[i] = 0.7F * image.bitmap[i] + 0.1F;
    AlignmentOptions options;
    options.exposure = ExposurePrior{};
    DenseAligner aligner(room(), camera(), options);
    std::mt19937_64 random(2);
    const Pose start = expSE3(test::randomTwist(0.04, 0.02, random)) * kPose;
    const Alignment a = aligner.align(image, start);
    EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
    EXPECT_NEAR(a.exposure.gain, 0.7, 0.005);
    EXPECT_NEAR(a.exposure.offset, 0.1, 0.005);
    EXPECT_LT(errorOf(a, kPose).norm(), 3e-3);
    // Unknown exposure can only cost information.
    DenseAligner fixed(room(), camera());
    const Alignment known = fixed.align(observe(room(), kPose, 0.01), kPose);
    EXPECT_LT(a.information.trace(), known.information.trace());
}

/// The fixed exposure and the free one are the ends of what a prior may be.
TEST(Exposure, ThePriorOfTheExposureLiesBetweenFixedAndFree) {
    ImageF image = observe(room(), kPose, 0.01);
    for (unsigned i = 0; i < image.getSize(); ++i) image.bitmap[i] = 0.95F * image.bitmap[i];
    const auto alignWith = [&](const std::optional<ExposurePrior>& prior) {
        AlignmentOptions options;
        options.exposure = prior;
        options.fineStep = 1e-3;
        DenseAligner aligner(room(), camera(), options);
        return aligner.align(image, {kPose, 1e-4 * Matrix6::Identity()});
    };
    const Alignment fixed = alignWith({});
    const Alignment tight = alignWith(ExposurePrior{1e-7, 1e-7});
    const Alignment wide = alignWith(ExposurePrior{100., 100.});
    const Alignment free = alignWith(ExposurePrior{});
    EXPECT_NEAR(tight.exposure.gain, 1., 1e-6);
    EXPECT_LT(logSE3(tight.T_c_w * fixed.T_c_w.inverse()).norm(), 1e-4);
    EXPECT_LT((tight.information - fixed.information).norm(), 1e-3 * fixed.information.norm());
    EXPECT_NEAR(wide.exposure.gain, free.exposure.gain, 1e-4);
    EXPECT_NEAR(free.exposure.gain, 0.95, 0.005);
    EXPECT_LT(logSE3(wide.T_c_w * free.T_c_w.inverse()).norm(), 1e-4);
    EXPECT_LT((wide.information - free.information).norm(), 1e-3 * free.information.norm());
    EXPECT_GT(tight.information.trace(), 1.01 * free.information.trace());
}

/// At a fixed pose the cost is quadratic in the exposure: one step leads to where it has no slope.
TEST(PoseEquations, TheStepOfTheExposureEndsInTheMinimumOfTheCost) {
    const PhotometricOptions photometric{.sigma = 0.3, .scale = 0.5};
    const ExposurePrior prior{0.05, 0.002};
    const ImageF image = observe(room(), kPose, 0.02);
    View view;
    room().render(camera(), kPose, view);
    for (unsigned i = 0; i < view.intensity.getSize(); ++i) view.intensity.bitmap[i] *= 0.8F;
    ViewComparison compare(camera(), photometric);
    const auto equationsAt = [&](const Exposure& e) { return compare(view, image, e, Loss{}); };
    const auto cost = [&](const Exposure& e) {
        return photometric.scale / (photometric.sigma * photometric.sigma) * equationsAt(e).loss +
               prior.squaredDistance(e);
    };
    const Exposure start{1.1, 0.01};
    const PoseEquations p = poseEquations(equationsAt(start), photometric, prior, start);
    const Exposure best{start.gain + p.exposureRhs[0], start.offset + p.exposureRhs[1]};
    EXPECT_GT(best.gain, 1.15) << "too easy";
    constexpr double kStep = 0.01;
    for (const Eigen::Vector2d& along : {Eigen::Vector2d(kStep, 0.), Eigen::Vector2d(0., kStep)}) {
        const double up = cost({best.gain + along[0], best.offset + along[1]});
        const double down = cost({best.gain - along[0], best.offset - along[1]});
        EXPECT_NEAR((up - down) / (up + down - 2. * cost(best)), 0., 0.01);
    }
}

/// The minimum is where it is, with whatever gain and offset the image was compared.
TEST(Exposure, AtWhichImagesAreComparedDoesNotChangeTheirInformation) {
    View view;
    room().render(camera(), kPose, view);
    ViewComparison compare(camera(), {});
    compare(view, observe(room(), kPose, 0.02), {}, {});
    const AlignmentOptions options = realCameraOptions();
    ComparedBlocks image{compare.blocks({}, {}), camera(), {}};
    const auto measured = [&] {
        return measuredInformation(image, options.photometric, options.exposure,
                                   options.modelErrors, Pose::Identity());
    };
    const MeasuredInformation before = measured();
    image.exposure = {1.1, -0.01};
    for (ImageBlock& block : image.blocks) {
        block.Atr -= block.AtA.rightCols<2>() * ExposurePrior::difference(image.exposure);
    }
    const MeasuredInformation after = measured();
    const Vector6 x = before.equations.information.ldlt().solve(before.equations.rhs);
    const Vector6 change = after.equations.information.ldlt().solve(after.equations.rhs) - x;
    EXPECT_LT(change.dot(before.equations.information * change), 1e-5);
    EXPECT_TRUE(after.equations.information.isApprox(before.equations.information, 1e-3));
    EXPECT_TRUE(after.repeating.isApprox(before.repeating, 1e-3));
}

/// Images that say as much about the exposure as the prior does.
TEST(Exposure, IsConsistentWhenExposuresAreDrawnFromThePrior) {
    const Camera small = makeCamera(64, 40, 1.2);
    const ExposurePrior prior{0.03, 0.01};
    AlignmentOptions options;
    options.photometric.sigma = 0.15;
    options.exposure = prior;
    options.trust.maxUnexplained = 1.;
    options.fineStep = 0.05;
    DenseAligner aligner(room(), small, options);
    Vector6 sigmas;
    sigmas << 0.02, 0.02, 0.02, 0.01, 0.01, 0.01;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    constexpr int kCount = 150;
    double nees = 0.;
    for (int k = 0; k < kCount; ++k) {
        ImageF image = observe(room(), kPose, 0., 1, small);
        const double gain = 1. + prior.gainSigma * normal(random);
        const double offset = prior.offsetSigma * normal(random);
        for (unsigned i = 0; i < image.getSize(); ++i) {
            image.bitmap[i] = static_cast<float>(gain * image.bitmap[i] + offset);
        }
        Vector6 xi;
        for (int i = 0; i < 6; ++i) xi[i] = sigmas[i] * normal(random);
        const Alignment a = aligner.align(test::noisy(image, options.photometric.sigma, random),
                                          {expSE3(xi) * kPose, sigmas.cwiseAbs2().asDiagonal()});
        nees += test::neesOf(a, kPose) / kCount;
    }
    EXPECT_NEAR(nees, 1., 3. * std::sqrt(2. / (6. * kCount)));
}

}  // namespace
}  // namespace photonav
