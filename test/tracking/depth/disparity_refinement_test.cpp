// SPDX-License-Identifier: BSD-3-Clause
#include "depth/disparity_refinement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace photonav {
namespace {

constexpr int kWidth = 120, kHeight = 60, kBlock = 15;

/// A slanted surface: its disparity at a pixel of the left image.
double disparityAt(double u, double v) { return 6. + 0.06 * (u - 60.) - 0.02 * (v - 30.); }

/// Its grey values at a pixel of the left image. On the right their contrast is four times less.
double greyAt(double u, double v) {
    const double contrast = 25. - 15. * std::tanh((u - 60.) / 4.);
    return 120. + contrast * std::sin(0.9 * u + 0.3 * v) * std::cos(0.35 * u - 0.8 * v);
}

class SlantedSurface : public testing::Test {
  protected:
    SlantedSurface()
        : left(kHeight, kWidth, CV_32F),
          right(kHeight, kWidth, CV_32F),
          disparity(kHeight, kWidth, CV_32F) {
        for (int v = 0; v < kHeight; ++v) {
            for (int u = 0; u < kWidth; ++u) {
                left.at<float>(v, u) = static_cast<float>(greyAt(u, v));
                // In the right image u_r = u - d(u) is linear in u.
                const double inLeft = (u + 6. - 0.06 * 60. - 0.02 * (v - 30.)) / (1. - 0.06);
                right.at<float>(v, u) = static_cast<float>(greyAt(inLeft, v));
                disparity.at<float>(v, u) = static_cast<float>(std::round(disparityAt(u, v)));
            }
        }
    }

    /// The largest error where blocks and their match are inside the images.
    double largestError() const {
        double largest = 0.;
        for (int v = 10; v < kHeight - 10; ++v) {
            for (int u = 25; u < kWidth - 10; ++u) {
                const double error = disparity.at<float>(v, u) - disparityAt(u, v);
                largest = std::max(largest, std::abs(error));
            }
        }
        return largest;
    }

    cv::Mat left, right, disparity;
};

TEST_F(SlantedSurface, HasTheDisparityOfTheMiddleOfABlock) {
    EXPECT_NEAR(largestError(), 0.5, 0.02);  // whole pixels
    refineDisparities(left, right, kBlock, 1., disparity);
    EXPECT_LT(largestError(), 0.05);
}

TEST_F(SlantedSurface, KeepsFewDisparitiesThatAreWrongByPixels) {
    disparity.rowRange(0, 30) += 3.;
    refineDisparities(left, right, kBlock, 1., disparity);
    int kept = 0;
    for (int v = 5; v < 20; ++v) {
        for (int u = 25; u < kWidth - 10; ++u) kept += disparity.at<float>(v, u) > 0.F ? 1 : 0;
    }
    EXPECT_LT(kept, 0.5 * 15 * (kWidth - 35));
}

TEST_F(SlantedSurface, HasNoneWhereThereWasNoneAndWithoutTexture) {
    disparity.colRange(0, 60) = 0.;
    cv::Mat(left.colRange(60, kWidth)) = 120.;
    cv::Mat(right.colRange(40, kWidth)) = 120.;
    refineDisparities(left, right, kBlock, 1., disparity);
    EXPECT_EQ(cv::countNonZero(disparity.colRange(0, 60)), 0);
    EXPECT_EQ(cv::countNonZero(disparity.colRange(80, kWidth)), 0);
}

/// Blocks end at the borders of the images, where they know less.
TEST_F(SlantedSurface, HasDisparitiesUpToTheBordersOfASmallImage) {
    const cv::Rect part(40, 20, 31, 9);       // lower than a block
    cv::Mat small = disparity(part).clone();  // of images that are cut alike
    refineDisparities(left(part).clone(), right(part).clone(), kBlock, 1., small);
    for (int v = 0; v < part.height; ++v) {
        for (int u = 10; u < part.width; ++u) {
            EXPECT_NEAR(small.at<float>(v, u), disparityAt(u + part.x, v + part.y), 0.25)
                << u << ", " << v;
        }
    }
}

}  // namespace
}  // namespace photonav
