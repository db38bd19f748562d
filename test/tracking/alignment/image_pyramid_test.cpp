// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/image_pyramid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <opencv2/imgproc.hpp>

#include "photometry/opencv_image.hpp"
#include "scene/texture.hpp"

namespace photonav {
namespace {

/// Standard deviation of a spot's brightness along x [pixels].
double spreadOf(const ImageF& image) {
    double sum = 0., first = 0., second = 0.;
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < image.getWidth(); ++u) {
            sum += image[v][u];
            first += u * image[v][u];
            second += u * u * image[v][u];
        }
    }
    return std::sqrt(second / sum - first / sum * (first / sum));
}

ImageF spot(unsigned size, double sigma) {
    ImageF image(size, size);
    const double centre = 0.5 * (size - 1.);
    for (unsigned v = 0; v < size; ++v) {
        for (unsigned u = 0; u < size; ++u) {
            const double distance = std::hypot(u - centre, v - centre) / sigma;
            image[v][u] = static_cast<float>(std::exp(-0.5 * distance * distance));
        }
    }
    return image;
}

TEST(ImagePyramid, BlurAfterHalvingIsThatOfTheHalvedImage) {
    for (const double sigma : {1.5, 3.}) {
        const ImageF half = halvedAsRendered(spot(80, sigma));
        EXPECT_NEAR(spreadOf(half), blurAfterHalving(sigma), 1e-3) << sigma;
    }
    EXPECT_NEAR(blurAfterHalving(kRenderedBlur), kRenderedBlur, 1e-4);
}

/// Wide point spreads, too: of a camera that is out of focus.
TEST(ImagePyramid, WidensByTheVarianceAskedFor) {
    constexpr int kSize = 41;
    ImageF point(kSize, kSize, 0.F);
    point[kSize / 2][kSize / 2] = 1.F;
    std::mt19937_64 random(1);
    std::normal_distribution<float> normal;
    ImageF noise(400, 400);
    for (unsigned i = 0; i < noise.getSize(); ++i) noise.bitmap[i] = normal(random);
    const double before = cv::norm(asMat(noise));
    for (const double variance : {-1., 0., 0.3, 0.5, 0.7, 3.4}) {
        const ImageF spread = widened(point, variance);
        double sum = 0., squares = 0.;
        for (int v = 0; v < kSize; ++v) {
            for (int u = 0; u < kSize; ++u) {
                sum += spread[v][u];
                squares += spread[v][u] * std::pow(u - kSize / 2, 2);
            }
        }
        EXPECT_NEAR(sum, 1., 1e-5) << variance;
        EXPECT_NEAR(squares, std::max(variance, 0.), 1e-5) << variance;
        constexpr double kWhite = 1e9;
        EXPECT_NEAR(noiseAfterWidening(variance, kWhite),
                    cv::norm(asMat(widened(noise, variance))) / before, 0.01)
            << variance;
    }
}

/// Cells of any size, also when the camera nearly touches the surface.
TEST(ImagePyramid, ContentFinerThanCellsIsWhatAGaussianRemoves) {
    const ImageF image =
        valueNoise({.size = {1.6, 1.2}, .cells = {0.6, 0.1, 0.03}, .seed = 3}).image;
    const Camera camera{160, 120, vpCameraParameters(100., 100., 79.5, 59.5)};
    const cv::Mat sharp = asMat(image);
    for (const double cell : {3., 20., 31., 33., 60., 150.}) {  // [pixels]
        cv::Mat smooth;
        cv::GaussianBlur(sharp, smooth, {}, 0.5 * cell);
        const double expected = cv::norm(sharp, smooth, cv::NORM_L2SQR) / image.getSize();
        EXPECT_NEAR(finerThan(0.01 * cell, 1., camera, image), expected, 0.02 * expected) << cell;
    }
    cv::Scalar mean, sigma;
    cv::meanStdDev(sharp, mean, sigma);
    const double variance = sigma[0] * sigma[0];
    for (const double depth : {1e-3, 1e-9, 0.}) {
        EXPECT_NEAR(finerThan(0.1, depth, camera, image), variance, 0.02 * variance) << depth;
    }
}

}  // namespace
}  // namespace photonav
