// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/certain_information.hpp"

#include <gtest/gtest.h>

#include "alignment/dense_aligner.hpp"
#include "estimation/calibration.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

double certainShareOf(const ViewSource& model, const Pose& T_c_w) {
    const Camera camera = makeCamera(188, 120, 1.2217);
    View view, between;
    model.render(camera, T_c_w, view);
    model.render(betweenPixels(camera), T_c_w, between);
    ViewComparison compare(camera, {});
    compare(view, atPixels(between.intensity), {}, {});
    return certainShare(compare.tiles({}));
}

/// Bars along world y of two grey values, whose borders no texture filter makes smooth.
/// @param width of the dark ones [m]
MeshRenderer planks(double period, double width) {
    Scene scene;
    const auto dark = addTexture(scene, uniformTexture(0.2F));
    const auto bright = addTexture(scene, uniformTexture(0.8F));
    for (double x = -8.; x < 8.; x += period) {
        addPlane(scene, {x, -20., 0.}, {width, 0., 0.}, {0., 40., 0.}, dark);
        addPlane(scene, {x + width, -20., 0.}, {period - width, 0., 0.}, {0., 40., 0.}, bright);
    }
    return MeshRenderer(std::move(scene));
}

MeshRenderer bars(double width, double softEdge) {
    return MeshRenderer(test::floorOf(stripes({.width = width, .softEdge = softEdge})));
}

/// Wide bars, joints as thin as a pixel (1.5 cm), and bars of few pixels: seen from above and
/// at an angle.
TEST(CertainInformation, NothingIsCertainAlongEdges) {
    for (const auto& floor : {planks(1., 0.5), planks(0.5, 0.01), planks(0.5, 0.02),
                              planks(0.06, 0.03), bars(0.5, 0.05), bars(0.05, 0.005)}) {
        for (int i = -30; i < 30; ++i) {
            EXPECT_LT(certainShareOf(floor, test::aboveBars(0.05 * i).mean), 0.5) << i;
            EXPECT_LT(certainShareOf(floor, lookFrom({0.13, 0.2, 1.5}, 0.6, 0.05 * i)), 0.5) << i;
        }
    }
}

TEST(CertainInformation, TextureIsCertain) {
    for (const double below : {0.3, 0.8, test::kDown}) {
        for (const double yaw : {0., 1., 2., 3.}) {
            const Pose T_c_w = lookFrom({2., 3., 1.5}, below, yaw);
            EXPECT_GT(certainShareOf(test::room(), T_c_w), 0.6) << below << ' ' << yaw;
        }
    }
}

/// Texture determines all directions, even without the false information of edges: half of the
/// views are not needed.
TEST(CertainInformation, TheSlopeOfTextureIsNotMeasured) {
    const Camera camera = makeCamera(188, 120, 1.2);
    AlignmentOptions assumed = photographOptions();
    assumed.measureCovariance = false;
    const Pose truth = lookFrom({1.5, 2., 1.5}, test::kOblique, 0.3);
    const View view = test::photographed(test::room(), camera, truth);
    const auto viewsWith = [&](const AlignmentOptions& options) {
        return DenseAligner(test::room(), camera, options).align(view.intensity, truth).iterations;
    };
    EXPECT_LT(viewsWith(photographOptions()), 16);
    EXPECT_GE(viewsWith(assumed), viewsWith(photographOptions()) + 13);
}

TEST(CertainInformation, FewTilesLeaveDirectionsOpen) {
    const MeshRenderer white(test::floorOf(uniformTexture(0.9F)));
    EXPECT_EQ(certainShareOf(white, lookFrom({0., 0., 2.}, 1.2)), 0.);
    GradientTile tile;
    tile.inverseDepth = 0.5;
    tile.pixels = 64;
    tile.model = tile.shared = Eigen::Matrix2d::Identity();
    std::vector<GradientTile> tiles;
    for (const double x : {-0.4, 0., 0.4}) {
        EXPECT_EQ(certainShare(tiles), 0.) << tiles.size();
        tile.x = x;
        tiles.push_back(tile);
    }
    EXPECT_EQ(certainShare(tiles), 0.);
}

/// Half a pixel aside, a ramp is the same after interpolation.
TEST(CertainInformation, ImagesBetweenPixelsAreInterpolatedAtPixels) {
    const Camera camera = makeCamera(20, 10, 1.2), between = betweenPixels(camera);
    const auto rampOf = [](const Camera& c) {
        ImageF image(c.height, c.width);
        for (unsigned v = 0; v < c.height; ++v) {
            for (unsigned u = 0; u < c.width; ++u) {
                image[v][u] = static_cast<float>(0.01 * (u - c.cx()) + 0.02 * (v - c.cy()));
            }
        }
        return image;
    };
    const ImageF expected = rampOf(camera), image = atPixels(rampOf(between));
    for (unsigned v = 0; v + 1 < camera.height; ++v) {
        for (unsigned u = 0; u + 1 < camera.width; ++u) {
            EXPECT_NEAR(image[v][u], expected[v][u], 1e-6);
        }
    }
}

}  // namespace
}  // namespace photonav
