// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/eigensystem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geometry/gaussian.hpp"

namespace photonav {
namespace {

Matrix6 randomCovariance(std::mt19937_64& random) {
    Matrix6 root;
    for (int i = 0; i < 6; ++i) root.col(i) = draw(Matrix6::Identity(), random);
    return root * root.transpose();
}

TEST(Eigensystem, FulfilsItsEquations) {
    std::mt19937_64 random(1);
    const Matrix6 A = randomCovariance(random), B = randomCovariance(random);
    const auto [values, V] = eigensystem(A);
    EXPECT_TRUE((A * V).isApprox(V * values.asDiagonal(), 1e-12));
    EXPECT_TRUE((V.transpose() * V).isIdentity(1e-12));
    EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
    const auto [ratios, W] = eigensystem(A, B);
    EXPECT_TRUE((A * W).isApprox(B * W * ratios.asDiagonal(), 1e-9));
    EXPECT_TRUE((W.transpose() * B * W).isIdentity(1e-9));
    EXPECT_TRUE(std::is_sorted(ratios.begin(), ratios.end()));
}

}  // namespace
}  // namespace photonav
