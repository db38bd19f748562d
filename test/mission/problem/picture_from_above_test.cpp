// SPDX-License-Identifier: BSD-3-Clause
#include "problem/picture_from_above.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tracking/rooms.hpp"

namespace photonav {
namespace {

constexpr double kPixel = 0.05;

/// A dark pillar of 10 cm, 2 m high, on a bright floor of 2 x 2 m, as seen below a height.
ImageF pillarAt(double x, double y, double top) {
    Scene scene = test::floorOf(uniformTexture(0.9F));
    addBox(scene, {x - 0.05, y - 0.05, 0.}, {x + 0.05, y + 0.05, 2.},
           addTexture(scene, uniformTexture(0.1F)));
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-1., -1.), Eigen::Vector2d(1., 1.));
    const std::vector<Prism> solids = scene.solids;
    return pictureFromAbove(MeshRenderer(std::move(scene)), area, top, 0., kPixel, solids);
}

/// However near the camera its upper end is, and right below it or beside it. Pixels at its border
/// are mixed with the floor: what is darker than the mean of both counts.
TEST(PictureFromAbove, ShowsThinThingsAsWideAsTheyAre) {
    for (const double top : {2.02, 2.1, 2.5, 4.}) {
        for (const double x : {0., 0.3}) {
            const ImageF picture = pillarAt(x, 0., top);
            const auto dark = std::count_if(picture.bitmap, picture.bitmap + picture.getSize(),
                                            [](float grey) { return grey < 0.5F; });
            EXPECT_GE(dark, 2) << top << ' ' << x;
            EXPECT_LE(dark, 12) << top << ' ' << x;
        }
    }
}

unsigned count(const ImageF& picture, float least, float most) {
    return std::count_if(picture.bitmap, picture.bitmap + picture.getSize(),
                         [&](float grey) { return grey >= least && grey <= most; });
}

/// A pillar that is higher than what is shown: as large as it is, 4 pixels, and darker than the
/// floor.
TEST(PictureFromAbove, FillsWhatIsCut) {
    const ImageF picture = pillarAt(0.35, -0.65, 1.);
    const auto row = static_cast<unsigned>((1. + 0.65) / 2. * picture.getHeight());
    const auto column = static_cast<unsigned>((1. + 0.35) / 2. * picture.getWidth());
    EXPECT_FLOAT_EQ(picture[row][column], 0.3F);
    EXPECT_GE(count(picture, 0.3F, 0.3F), 4U);
    EXPECT_LE(count(picture, 0.3F, 0.3F), 9U);
}

TEST(PictureFromAbove, ALintelIsNoWall) {
    Scene scene = test::floorOf(uniformTexture(0.9F));
    addBox(scene, {-1., -0.2, 1.8}, {1., 0.2, 2.5}, addTexture(scene, uniformTexture(0.7F)));
    const std::vector<Prism> solids = scene.solids;
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-1., -1.), Eigen::Vector2d(1., 1.));
    const ImageF picture =
        pictureFromAbove(MeshRenderer(std::move(scene)), area, 2., 0., kPixel, solids);
    EXPECT_EQ(count(picture, 0.3F, 0.3F), 0U);
    EXPECT_GT(count(picture, 0.65F, 0.75F), 100U);
}

/// A tile's camera is right in the plane of the pillar's face at x = 0 or y = 0, unless it avoids
/// round coordinates.
TEST(PictureFromAbove, HasNoHolesBesideFaces) {
    for (const double top : {1., 2., 2.5}) {
        EXPECT_EQ(count(pillarAt(0.05, 0., top), 1.F, 1.F), 0U) << top;
        EXPECT_EQ(count(pillarAt(0., 0.05, top), 1.F, 1.F), 0U) << top;
        EXPECT_EQ(count(pillarAt(0.05, 0.05, top), 1.F, 1.F), 0U) << top;
    }
}

/// The first row is at the largest y.
TEST(PictureFromAbove, ShowsThemWhereTheyAre) {
    const ImageF picture = pillarAt(0.35, -0.65, 2.1);
    const auto row = static_cast<unsigned>((1. + 0.65) / 2. * picture.getHeight());
    const auto column = static_cast<unsigned>((1. + 0.35) / 2. * picture.getWidth());
    EXPECT_LT(picture[row][column], 0.2F);
    EXPECT_GT(picture[picture.getHeight() - 1 - row][column], 0.8F);
}

}  // namespace
}  // namespace photonav
