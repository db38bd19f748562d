// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/bilinear.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

TEST(Bilinear, IsTheImageAtPixelsAndStraightBetweenThem) {
    ImageF image(3, 4);
    for (unsigned v = 0; v < 3; ++v) {
        for (unsigned u = 0; u < 4; ++u) image[v][u] = 0.1F * u + 0.2F * v + 0.05F * u * v;
    }
    EXPECT_EQ(bilinear(image, 2., 1.), image[1][2]);
    EXPECT_NEAR(bilinear(image, 1.3, 0.6), 0.1 * 1.3 + 0.2 * 0.6 + 0.05 * 1.3 * 0.6, 1e-6);
}

}  // namespace
}  // namespace photonav
