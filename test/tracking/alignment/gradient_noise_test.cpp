// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/gradient_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>
#include <vector>

namespace photonav {
namespace {

struct Point {
    double x, y, inverseDepth;
};

/// Equations of pixels with random gradients, of which `points` stand for the motions.
Matrix6 afterSubtraction(const std::vector<Point>& pixels, const std::vector<Point>& points) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    NormalEquations equations;
    for (const auto& [x, y, w] : pixels) {
        const Vector6 du{{w, 0., x * w, x * y, x * x + 1., -y}};
        const Vector6 dv{{0., w, y * w, y * y + 1., x * y, x}};
        const Vector6 J = normal(random) * du + normal(random) * dv;
        equations.AtA.topLeftCorner<6, 6>() += J * J.transpose();
    }
    // Images are summed in single precision.
    equations.AtA = equations.AtA.cast<float>().cast<double>().eval();
    const auto count = static_cast<double>(pixels.size());
    equations.AtA(7, 7) = equations.count = count;
    GradientNoise noise;
    for (const auto& [x, y, w] : points) noise.add(x, y, w);
    noise.subtractFrom(equations, {0.3 * count, 0.3 * count}, 1., Vector6::Ones());
    return equations.AtA.topLeftCorner<6, 6>();
}

/// The motions of one point, or of points on a line, do not determine a pose: the noise has no
/// inverse, and whether its factorisation fails or divides by rounding errors is chance. A
/// covariance that is updated with negative information can have a negative trace.
TEST(GradientNoise, LeavesNoNegativeInformationWhereItIsSingular) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> inView(-0.5, 0.5), inverseDepth(0.2, 1.);
    for (int trial = 0; trial < 200; ++trial) {
        const Point first{inView(random), inView(random), inverseDepth(random)};
        const auto moved = [&](double x, double y) {
            return Point{first.x + x, first.y + y, first.inverseDepth};
        };
        std::vector<Point> pixels, line;
        for (int i = 0; i < 16; ++i) pixels.push_back(moved(0.01 * (i % 4), 0.01 * (i / 4)));
        for (int i = 0; i < 8; ++i) line.push_back(moved(0.005 * i, 0.01));
        for (const auto& points : {std::vector{first}, {first, pixels[7]}, line}) {
            const Matrix6 left = afterSubtraction(pixels, points);
            const Eigen::SelfAdjointEigenSolver<Matrix6> solver(0.5 * (left + left.transpose()));
            EXPECT_GE(solver.eigenvalues()[0], -1e-6 * solver.eigenvalues()[5])
                << points.size() << " points";
        }
    }
}

TEST(GradientNoise, IsSubtractedWhereItHasAnInverse) {
    std::vector<Point> pixels;
    for (int i = 0; i < 16; ++i) pixels.push_back({0.1 * (i % 4), 0.1 * (i / 4), 0.5});
    EXPECT_LT(afterSubtraction(pixels, pixels).trace(), 0.9 * afterSubtraction(pixels, {}).trace());
}

}  // namespace
}  // namespace photonav
