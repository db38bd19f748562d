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
    return pictureFromAbove(MeshRenderer(std::move(scene)), area, top, 0., kPixel);
}

/// However near the camera its upper end is, and right below it or beside it.
TEST(PictureFromAbove, ShowsThinThingsAsWideAsTheyAre) {
    for (const double top : {2.02, 2.1, 2.5, 4.}) {
        for (const double x : {0., 0.3}) {
            const ImageF picture = pillarAt(x, 0., top);
            const auto dark = std::count_if(picture.bitmap, picture.bitmap + picture.getSize(),
                                            [](float grey) { return grey < 0.2F; });
            EXPECT_GE(dark, 2) << top << ' ' << x;
            EXPECT_LE(dark, 12) << top << ' ' << x;
        }
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
