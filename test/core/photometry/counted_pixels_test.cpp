// SPDX-License-Identifier: BSD-3-Clause
// Which pixels have information: every rule on its own.
#include <gtest/gtest.h>

#include <limits>

#include "analytic_plane.hpp"
#include "core/photometry/random_view.hpp"

namespace photonav {
namespace {

using test::countingPixels;
using test::randomView;

TEST(Counts, NotTheBorder) {
    const Camera camera = defaultCamera();
    const View view = randomView(camera, 3);
    for (unsigned u = 0; u < camera.width; ++u) {
        EXPECT_TRUE(pixelJacobian(view, camera, u, 0).isZero(0.));
        EXPECT_TRUE(pixelJacobian(view, camera, u, camera.height - 1).isZero(0.));
    }
    EXPECT_TRUE(pixelJacobian(view, camera, 0, 5).isZero(0.));
    EXPECT_TRUE(pixelJacobian(view, camera, camera.width - 1, 5).isZero(0.));
    EXPECT_EQ(countingPixels(view, camera), (camera.width - 2) * (camera.height - 2));
}

TEST(Counts, NotWithoutDepthHereOrNextDoor) {
    const Camera camera = defaultCamera();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (float nothing : {0.F, -1.F, nan}) {
        View view = randomView(camera, 4);
        const unsigned all = countingPixels(view, camera);
        view.depth[50][60] = nothing;
        for (auto [u, v] : {std::pair{60U, 50U}, {59U, 50U}, {61U, 50U}, {60U, 49U}, {60U, 51U}}) {
            EXPECT_TRUE(pixelJacobian(view, camera, u, v).isZero(0.)) << u << " " << v;
        }
        EXPECT_EQ(countingPixels(view, camera), all - 5);
        EXPECT_TRUE(photometricInformation(view, camera).allFinite());
        view.depth = nothing;
        EXPECT_EQ(photometricInformation(view, camera), Matrix6::Zero());
    }
}

TEST(Counts, NotAcrossADepthDiscontinuity) {
    const Camera camera = defaultCamera();
    View view = randomView(camera, 5);
    for (bool vertical : {false, true}) {
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 0; u < camera.width; ++u) {
                view.depth[v][u] = (vertical ? u < 90 : v < 60) ? 2.F : 2.3F;
            }
        }
        for (unsigned i : {5U, 80U}) {
            const auto at = [&](unsigned k) {
                return vertical ? pixelJacobian(view, camera, k, i)
                                : pixelJacobian(view, camera, i, k - 30);
            };
            EXPECT_FALSE(at(88).isZero(0.));
            EXPECT_TRUE(at(89).isZero(0.));
            EXPECT_TRUE(at(90).isZero(0.));
            EXPECT_FALSE(at(91).isZero(0.));
        }
    }
}

TEST(Counts, APlaneHoweverOblique) {
    const Camera camera = defaultCamera();
    AnalyticPlane floor;
    // 3 degrees below the horizon, cut off by the image just below the vanishing line: depth
    // changes by tens of per cent from row to row.
    const Pose T_c_w = lookFrom({0., 0., 1.}, 27. * std::numbers::pi / 180.);
    View view = floor.view(camera, T_c_w);
    unsigned surfaces = 0;
    for (unsigned v = 1; v + 1 < camera.height; ++v) {
        for (unsigned u = 1; u + 1 < camera.width; ++u) {
            if (!(view.depth[v - 1][u] > 0.F)) continue;
            ++surfaces;
            view.intensity[v][u] = ((u + v) % 4 < 2) ? 0.3F : 0.6F;
        }
    }
    EXPECT_GT(surfaces, 15000U);
    EXPECT_GT(view.depth[1][60] / view.depth[3][60], 1.2F) << "not oblique enough to test";
    EXPECT_GT(countingPixels(view, camera), surfaces - 400);
}

TEST(Counts, NotWhenSaturated) {
    const Camera camera = defaultCamera();
    View view = randomView(camera, 6);
    for (float grey : {0.F, 0.0005F, 0.9995F, 1.F}) {
        view.intensity[40][30] = grey;
        EXPECT_TRUE(pixelJacobian(view, camera, 30, 40).isZero(0.)) << grey;
        EXPECT_FALSE(pixelJacobian(view, camera, 31, 40).isZero(0.)) << grey;
    }
    for (float grey : {0.002F, 0.998F}) {
        view.intensity[40][30] = grey;
        EXPECT_FALSE(pixelJacobian(view, camera, 30, 40).isZero(0.)) << grey;
    }
}

}  // namespace
}  // namespace photonav
