// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/map_uncertainty.hpp"

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

TEST(MapUncertainty, BlankWallStaysAsUncertainAsItWas) {
    View wall;
    wall.intensity.resize(64, 96, 0.5F);
    wall.depth.resize(64, 96, 2.F);
    EXPECT_EQ(mapCertainty(wall, someCamera()).remainingVariance(Vector3d::UnitX()), 1.);
}

TEST(MapUncertainty, StripesAreMeasuredByFlyingAcrossThemOnly) {
    AnalyticPlane floor;
    floor.stripes = true;
    const MapCertainty certainty = mapCertainty(fromAbove(floor), someCamera());
    EXPECT_LT(certainty.remainingVariance(Vector3d::UnitY()), 0.2);         // across: world x
    EXPECT_NEAR(certainty.remainingVariance(Vector3d::UnitX()), 1., 1e-4);  // along
}

TEST(MapUncertainty, GainIsTheTranslationPartOfThePhotometricInformation) {
    // Where every pixel counts: priorSigma^2 baseline^2 / (2 n) * the block of Lambda.
    const MapUncertaintyOptions options{.priorSigma = 1e4, .baseline = 0.1, .stride = 1};
    const View view = fromAbove(AnalyticPlane{});
    const MapCertainty certainty = mapCertainty(view, someCamera(), {}, options);
    const double pixels = 94. * 62.;  // without the border
    const Eigen::Matrix3d expected =
        1e8 * 1e-2 / (2. * pixels) *
        photometricInformation(view, someCamera()).topLeftCorner<3, 3>();
    EXPECT_NEAR(certainty.share, pixels / (96. * 64.), 1e-3);
    EXPECT_LT((certainty.gain - expected).norm(), 1e-3 * expected.norm());
}

TEST(MapUncertainty, WhatIsNotTexturedStaysUncertain) {
    const Camera camera = someCamera();
    View view = fromAbove(AnalyticPlane{});
    const MapCertainty whole = mapCertainty(view, camera);
    EXPECT_LT(whole.remainingVariance(Vector3d::UnitX()), 0.4);
    for (unsigned v = 0; v < 64; ++v) {
        for (unsigned u = 0; u < 48; ++u) view.intensity[v][u] = 0.5F;
    }
    const MapCertainty half = mapCertainty(view, camera);
    EXPECT_LT(half.share, 0.51);
    EXPECT_GT(half.share, 0.4 * whole.share);
    EXPECT_GT(half.remainingVariance(Vector3d::UnitX()), 0.5);
}

TEST(MapUncertainty, LessIsLeftOfALongerBaseline) {
    const View view = fromAbove(AnalyticPlane{});
    const auto left = [&](double baseline) {
        return mapCertainty(view, someCamera(), {}, {.baseline = baseline})
            .remainingVariance(Vector3d::UnitX());
    };
    EXPECT_LT(left(0.5), left(0.25));
    EXPECT_LT(left(0.25), left(0.1));
}

}  // namespace
}  // namespace photonav
