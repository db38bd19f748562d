// SPDX-License-Identifier: BSD-3-Clause
#include "map_uncertainty.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "analytic_plane.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

Camera someCamera() { return makeCamera(96, 64, 70. * std::numbers::pi / 180.); }

/// The floor from 2 m above: image right is world -y, image up is world x.
View fromAbove(const AnalyticPlane& floor) {
    return floor.view(someCamera(), lookFrom({0.3, -0.2, 2.}, std::numbers::pi / 2.));
}

double varianceLeft(const Eigen::Matrix3d& certainty, const Vector3d& t) {
    return 1. - t.dot(certainty * t);
}

TEST(MapUncertainty, BlankWallStaysAsUncertainAsItWas) {
    View wall;
    wall.intensity.resize(64, 96, 0.5F);
    wall.depth.resize(64, 96, 2.F);
    EXPECT_TRUE(mapCertainty(wall, someCamera()).isZero(0.));
}

TEST(MapUncertainty, StripesAreMeasuredByFlyingAcrossThemOnly) {
    AnalyticPlane floor;
    floor.stripes = true;
    const Eigen::Matrix3d certainty = mapCertainty(fromAbove(floor), someCamera());
    EXPECT_LT(varianceLeft(certainty, Vector3d::UnitY()), 0.2);         // across: world x
    EXPECT_NEAR(varianceLeft(certainty, Vector3d::UnitX()), 1., 1e-4);  // along
}

TEST(MapUncertainty, LittleParallaxIsWorthTheTranslationPartOfThePhotometricInformation) {
    // g << 1: M = priorSigma^2 baseline^2 / (2 n) * the block of Lambda that is about translation.
    const MapUncertaintyOptions options{.priorSigma = 1e-3, .baseline = 1e-2};
    const View view = fromAbove(AnalyticPlane{});
    const Eigen::Matrix3d certainty = mapCertainty(view, someCamera(), {}, options);
    const Eigen::Matrix3d block = photometricInformation(view, someCamera()).topLeftCorner<3, 3>();
    const Eigen::Matrix3d expected = 1e-6 * 1e-4 / (2. * 96. * 64.) * block;
    EXPECT_LT((certainty - expected).norm(), 1e-3 * expected.norm());
}

TEST(MapUncertainty, MuchParallaxMeasuresEveryPixelThatCanMove) {
    // g >> 1: every pixel with a gradient is known along it. tr M is their share of the image.
    const Eigen::Matrix3d certainty =
        mapCertainty(fromAbove(AnalyticPlane{}), someCamera(), {}, {.priorSigma = 1e4});
    EXPECT_NEAR(certainty.trace(), 94. * 62. / (96. * 64.), 1e-3);
}

TEST(MapUncertainty, LessIsLeftOfALongerBaseline) {
    const View view = fromAbove(AnalyticPlane{});
    const auto left = [&](double baseline) {
        return varianceLeft(mapCertainty(view, someCamera(), {}, {.baseline = baseline}),
                            Vector3d::UnitX());
    };
    EXPECT_LT(left(0.5), left(0.25));
    EXPECT_LT(left(0.25), left(0.1));
}

}  // namespace
}  // namespace photonav
