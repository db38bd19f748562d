// SPDX-License-Identifier: BSD-3-Clause
#include "problem/picture_from_above.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tracking/rooms.hpp"

namespace photonav {
namespace {

/// A dark pillar of 10 cm, 2 m high, on a bright floor.
class PictureFromAbove : public testing::Test {
  protected:
    static std::unique_ptr<MeshRenderer> pillar() {
        Scene scene = test::floorOf(uniformTexture(0.9F));
        addBox(scene, {0.3, -0.7, 0.}, {0.4, -0.6, 2.}, addTexture(scene, uniformTexture(0.1F)));
        return std::make_unique<MeshRenderer>(std::move(scene));
    }
    ImageF below(double top) const { return pictureFromAbove(*views_, area_, top, 0., kPixel); }
    static auto darkPixels(const ImageF& picture) {
        return std::count_if(picture.bitmap, picture.bitmap + picture.getSize(),
                             [](float grey) { return grey < 0.2F; });
    }

    static constexpr double kPixel = 0.05;
    std::unique_ptr<MeshRenderer> views_ = pillar();
    Eigen::AlignedBox2d area_{Eigen::Vector2d(-1., -1.), Eigen::Vector2d(1., 1.)};
};

/// However near the camera its upper end is.
TEST_F(PictureFromAbove, ShowsThinThingsAsWideAsTheyAre) {
    for (const double top : {2.02, 2.1, 2.5, 4.}) {
        const ImageF picture = below(top);
        EXPECT_GE(darkPixels(picture), 2) << top;
        EXPECT_LE(darkPixels(picture), 12) << top;
    }
}

/// The first row is at the largest y.
TEST_F(PictureFromAbove, ShowsThemWhereTheyAre) {
    const ImageF picture = below(2.1);
    const auto row = static_cast<unsigned>((1. + 0.65) / 2. * picture.getHeight());
    const auto column = static_cast<unsigned>((1. + 0.35) / 2. * picture.getWidth());
    EXPECT_LT(picture[row][column], 0.2F);
    EXPECT_GT(picture[picture.getHeight() - 1 - row][column], 0.8F);
}

}  // namespace
}  // namespace photonav
