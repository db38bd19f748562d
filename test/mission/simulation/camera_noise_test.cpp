// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/camera_noise.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

constexpr unsigned kSize = 101;

ImageF grey(float value) { return ImageF(kSize, kSize, value); }

CameraNoiseOptions noiseless() {
    return {.blur = 0.,
            .vignetting = 0.,
            .exposure = {},
            .electronsAtWhite = 1e12,
            .readNoise = 0.,
            .bits = 0};
}

double variance(const ImageF& image) {
    double sum = 0., squares = 0.;
    for (unsigned i = 0; i < image.getSize(); ++i) {
        sum += image.bitmap[i];
        squares += double(image.bitmap[i]) * image.bitmap[i];
    }
    const double n = image.getSize();
    return squares / n - sum * sum / n / n;
}

TEST(CameraNoise, IsNothingWhenEverythingIsOff) {
    std::mt19937_64 random(1);
    const ImageF image = takePicture(grey(0.4F), noiseless(), random);
    EXPECT_NEAR(image[50][50], 0.4, 1e-5);
    EXPECT_NEAR(image[0][0], 0.4, 1e-5);
}

TEST(CameraNoise, ShotNoiseGrowsWithLightAndReadNoiseDoesNot) {
    std::mt19937_64 random(2);
    CameraNoiseOptions options = noiseless();
    options.electronsAtWhite = 1000.;
    options.readNoise = 5.;
    for (const float light : {0.2F, 0.8F}) {
        const double expected = light / 1000. + 25e-6;
        EXPECT_NEAR(variance(takePicture(grey(light), options, random)) / expected, 1., 0.06);
    }
}

TEST(CameraNoise, ExposesVignettesClipsAndQuantises) {
    std::mt19937_64 random(3);
    CameraNoiseOptions options = noiseless();
    options.exposure = {1.5, 0.1};
    options.vignetting = 0.2;
    ImageF image = takePicture(grey(0.4F), options, random);
    EXPECT_NEAR(image[50][50], 0.7, 1e-5);
    EXPECT_NEAR(image[0][0], 0.6 * 0.8 + 0.1, 1e-5);
    EXPECT_EQ(takePicture(grey(0.9F), options, random)[50][50], 1.F);
    options.bits = 2;  // 0, 1/3, 2/3, 1
    EXPECT_NEAR(takePicture(grey(0.4F), options, random)[50][50], 2. / 3., 1e-6);
}

/// Every copy is a camera of its own: flights on several threads share the original.
TEST(CameraNoise, ExposureWandersSlowly) {
    const ImageNoise original = realNoise(noiseless(), {.gainSigma = 0.1, .correlation = 0.9});
    std::mt19937_64 random(5);
    double squares = 0., steps = 0.;
    constexpr int kCameras = 200;
    for (int k = 0; k < kCameras; ++k) {
        ImageNoise camera = original;
        ImageF first(3, 3, 0.5F), second(3, 3, 0.5F);
        camera(first, random, {});
        camera(second, random, {});
        const double gain = first[1][1] / 0.5 - 1.;
        const double step = second[1][1] / 0.5 - 1. - gain;
        EXPECT_LE(std::abs(gain), 0.2 + 1e-5);
        squares += gain * gain / kCameras;
        steps += step * step / kCameras;
    }
    EXPECT_NEAR(std::sqrt(squares), 0.1, 0.015);
    EXPECT_NEAR(std::sqrt(steps), 0.1 * std::sqrt(2. - 2. * 0.9), 0.008);
}

TEST(CameraNoise, BlurSpreadsAPointAndKeepsItsLight) {
    std::mt19937_64 random(4);
    ImageF point = grey(0.F);
    point[50][50] = 1.F;
    CameraNoiseOptions options = noiseless();
    options.blur = 1.5;
    const ImageF image = takePicture(point, options, random);
    double sum = 0., spread = 0.;
    for (int v = 0; v < int(kSize); ++v) {
        for (int u = 0; u < int(kSize); ++u) {
            sum += image[v][u];
            spread += image[v][u] * (u - 50) * (u - 50);
        }
    }
    EXPECT_NEAR(sum, 1., 1e-3);
    EXPECT_NEAR(std::sqrt(spread), 1.5, 0.05);
}
/// What the planner assumes of an image: its variance, and that Lambda with the scale is right.
TEST(AssumedNoise, HasTheVarianceAndTheInformationAssumed) {
    const PhotometricOptions options{.sigma = 0.02, .scale = 0.08};
    const ImageNoise noise = assumedNoise(options);
    std::mt19937_64 random(1);
    double square = 0., blocks = 0.;
    int pixels = 0, count = 0;
    for (int i = 0; i < 40; ++i) {
        ImageF image(64, 64, 0.F);
        noise(image, random, {});
        for (unsigned v = 0; v < 64; v += 16) {
            for (unsigned u = 0; u < 64; u += 16) {
                double sum = 0.;
                for (unsigned k = 0; k < 256; ++k) {
                    const double x = image[v + k / 16][u + k % 16];
                    sum += x;
                    square += x * x;
                    ++pixels;
                }
                blocks += sum * sum / 256.;
                ++count;
            }
        }
    }
    EXPECT_NEAR(std::sqrt(square / pixels), 0.02, 0.001);
    // Sums over areas vary as if there were 0.08 times as many pixels (less at the areas' edges).
    const double ratio = blocks / count / (0.02 * 0.02);
    EXPECT_GT(ratio, 0.7 / 0.08);
    EXPECT_LT(ratio, 1.05 / 0.08);
}

TEST(CameraNoise, DepthErrorsGrowWithDepthSquared) {
    std::mt19937_64 random(5);
    for (const float z : {1.F, 3.F}) {
        ImageF depth = grey(z);
        addDepthNoise(depth, {.sigmaAtOneMetre = 0.002, .missing = 0.}, random);
        EXPECT_NEAR(std::sqrt(variance(depth)), 0.002 * z * z, 0.0001 * z * z);
    }
    ImageF depth = grey(2.F);
    depth[3][3] = 0.F;
    addDepthNoise(depth, {.missing = 0.25}, random);
    int missing = 0;
    for (unsigned i = 0; i < depth.getSize(); ++i) missing += depth.bitmap[i] == 0.F ? 1 : 0;
    EXPECT_NEAR(missing / double(depth.getSize()), 0.25, 0.02);
    EXPECT_EQ(depth[3][3], 0.F);
}

/// The noise of an image of 48 million pixels takes seconds.
TEST(CameraNoise, IsInterruptedWithinAnImage) {
    std::mt19937_64 random(5);
    unsigned asked = 0;
    const IsStopped inTheMiddle = [&] { return ++asked > kSize / 2; };
    const auto expectInterrupted = [&](const char* what, const auto& add) {
        asked = 0;
        ImageF image = grey(0.5F);
        EXPECT_THROW(add(image), Interrupted) << what;
        EXPECT_EQ(asked, kSize / 2 + 1) << what;
    };
    expectInterrupted("assumed", [&](ImageF& image) {
        assumedNoise({.sigma = 0.02})(image, random, inTheMiddle);
    });
    expectInterrupted("real", [&](ImageF& image) { realNoise()(image, random, inTheMiddle); });
    expectInterrupted("depth",
                      [&](ImageF& image) { addDepthNoise(image, {}, random, inTheMiddle); });
}

}  // namespace
}  // namespace photonav
