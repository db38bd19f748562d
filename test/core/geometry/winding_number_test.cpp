// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/winding_number.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace photonav {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

TEST(WindingNumber, CountsTurnsWithTheirDirection) {
    Corners square{{0., 0.}, {2., 0.}, {2., 2.}, {0., 2.}};
    EXPECT_EQ(windingNumber(square, {1., 1.}), 1);
    EXPECT_EQ(windingNumber(square, {3., 1.}), 0);
    EXPECT_EQ(windingNumber(square, {-1., 1.}), 0);
    EXPECT_EQ(windingNumber(square, {1., 0.}), windingNumber(square, {1., 1e-9}));
    Corners twice = square;
    twice.insert(twice.end(), square.begin(), square.end());
    EXPECT_EQ(windingNumber(twice, {1., 1.}), 2);
    std::reverse(square.begin(), square.end());
    EXPECT_EQ(windingNumber(square, {1., 1.}), -1);
}

TEST(WindingNumber, TheTwoHalvesOfAnEightTurnOppositely) {
    const Corners eight{{0., 0.}, {2., 1.}, {2., 0.}, {0., 1.}};
    const int left = windingNumber(eight, {0.2, 0.5}), right = windingNumber(eight, {1.8, 0.5});
    EXPECT_EQ(left, -right);
    EXPECT_NE(left, 0);
}

TEST(WindingNumber, OfNothingIsZero) {
    EXPECT_EQ(windingNumber({}, {0., 0.}), 0);
    // There and back
    EXPECT_EQ(windingNumber(Corners{{0., 0.}, {1., 1.}, {2., 0.}, {1., 1.}}, {1., 0.5}), 0);
}

}  // namespace
}  // namespace photonav
