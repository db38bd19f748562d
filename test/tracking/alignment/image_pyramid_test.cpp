// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/image_pyramid.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace photonav
