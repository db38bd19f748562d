// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/feature_information.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "analytic_plane.hpp"
#include "geometry/se3.hpp"
#include "photometry/photometric.hpp"

namespace photonav {
namespace {

constexpr double kDepth = 2.;

/// A camera whose principal point is a pixel.
Camera oddCamera() { return makeCamera(189, 121, 70. * std::numbers::pi / 180.); }

/// A grey wall, fronto-parallel, with a small blurred dot at each of the pixels.
View dots(const Camera& camera, const std::vector<std::pair<int, int>>& pixels,
          float contrast = 0.4F) {
    View view;
    view.intensity.resize(camera.height, camera.width, 0.5F);
    view.depth.resize(camera.height, camera.width, static_cast<float>(kDepth));
    for (const auto& [u, v] : pixels) {
        for (int row = -2; row <= 2; ++row) {
            for (int column = -2; column <= 2; ++column) {
                view.intensity[v + row][u + column] +=
                    contrast * std::exp(-0.5F * static_cast<float>(row * row + column * column));
            }
        }
    }
    return view;
}

TEST(Features, IsolatedDotsAreOneCornerEach) {
    const std::vector<std::pair<int, int>> pixels{{30, 20}, {94, 60}, {150, 33}, {77, 99}};
    const auto features = visibleFeatures(dots(oddCamera(), pixels));
    ASSERT_EQ(features.size(), pixels.size());
    for (const Feature& feature : features) {
        const auto at = std::pair(static_cast<int>(feature.u), static_cast<int>(feature.v));
        EXPECT_NE(std::find(pixels.begin(), pixels.end(), at), pixels.end());
        EXPECT_EQ(feature.depth, kDepth);
    }
}

TEST(Features, NeedContrastAndASurface) {
    const Camera camera = oddCamera();
    EXPECT_TRUE(visibleFeatures(dots(camera, {})).empty());
    EXPECT_TRUE(visibleFeatures(dots(camera, {{94, 60}}, 0.015F)).empty());
    EXPECT_EQ(visibleFeatures(dots(camera, {{94, 60}}, 0.015F), {.threshold = 0.005}).size(), 1U);
    View sky = dots(camera, {{94, 60}});
    sky.depth = 0.F;
    EXPECT_TRUE(visibleFeatures(sky).empty());
}

TEST(Features, AreNotFoundOnStripesWhichAreWorthMuchToEveryPixel) {
    const Camera camera = oddCamera();
    AnalyticPlane floor;
    floor.stripes = true;
    floor.wavelength = 0.3;
    const View view = floor.view(camera, lookFrom({0., 0., 2.}, std::numbers::pi / 2.));
    EXPECT_TRUE(visibleFeatures(view).empty());
    EXPECT_GT(photometricInformation(view, camera).trace(), 1e6);
}

TEST(ReprojectionInformation, OfACornerInTheMiddleIsKnown) {
    // J = f / Z [1 0 0 0 Z 0; 0 1 0 -Z 0 0] at the principal point.
    const Camera camera = oddCamera();
    const FeatureOptions options{.pixelSigma = 0.5};
    const auto features = visibleFeatures(dots(camera, {{94, 60}}), options);
    Eigen::Matrix<double, 2, 6> J;
    J << 1., 0., 0., 0., kDepth, 0., 0., 1., 0., -kDepth, 0., 0.;
    J *= camera.fx() / kDepth;
    const Matrix6 expected = J.transpose() * J / 0.25;
    const Matrix6 information = reprojectionInformation(features, camera, options);
    EXPECT_LT((information - expected).norm(), 1e-9 * expected.norm());
}

TEST(ReprojectionInformation, IsTheSecondDerivativeOfTheReprojectionError) {
    const Camera camera = oddCamera();
    const std::vector<Feature> features{{10., 100., 1.3}, {150., 20., 3.}, {60., 70., 0.8}};
    const auto project = [&](const Eigen::Vector3d& p) {
        return Eigen::Vector2d(camera.fx() * p.x() / p.z() + camera.cx(),
                               camera.fy() * p.y() / p.z() + camera.cy());
    };
    Eigen::MatrixXd J(2 * features.size(), 6);
    for (int i = 0; i < 6; ++i) {
        const double step = 1e-6;
        for (std::size_t k = 0; k < features.size(); ++k) {
            const Feature& f = features[k];
            const Eigen::Vector3d p((f.u - camera.cx()) / camera.fx() * f.depth,
                                    (f.v - camera.cy()) / camera.fy() * f.depth, f.depth);
            J.block<2, 1>(2 * static_cast<int>(k), i) =
                (project(expSE3(step * Vector6::Unit(i)) * p) -
                 project(expSE3(-step * Vector6::Unit(i)) * p)) /
                (2. * step);
        }
    }
    const Matrix6 expected = J.transpose() * J;
    EXPECT_LT((reprojectionInformation(features, camera) - expected).norm(),
              1e-6 * expected.norm());
}

TEST(ReprojectionInformation, IsZeroWithoutCorners) {
    EXPECT_TRUE(reprojectionInformation({}, oddCamera()).isZero(0.));
}

TEST(FeaturePenalty, FallsFromOneAndIsHalfAtTheReference) {
    EXPECT_EQ(featurePenalty(0), 1.);
    EXPECT_DOUBLE_EQ(featurePenalty(50, {.referenceCount = 50.}), 0.5);
    for (std::size_t n = 0; n < 500; ++n) EXPECT_LT(featurePenalty(n + 1), featurePenalty(n));
}

}  // namespace
}  // namespace photonav
