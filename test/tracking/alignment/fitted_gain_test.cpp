// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/fitted_gain.hpp"

#include <gtest/gtest.h>

#include "alignment/image_pyramid.hpp"
#include "tracking/alignment/room_images.hpp"

namespace photonav {
namespace {

using test::camera;
using test::kPose;
using test::observe;
using test::room;

ImageF exposed(ImageF image, double gain) {
    for (unsigned k = 0; k < image.getSize(); ++k) {
        image.bitmap[k] = static_cast<float>(gain * image.bitmap[k]);
    }
    return image;
}

View viewOfRoom() {
    View view;
    room().render(camera(), kPose, view);
    return view;
}

/// The image is blurred, noisy, and taken a centimetre and half a degree aside.
TEST(FittedGain, DoesNotDependOnSharpnessNoiseAndSmallErrorsOfThePose) {
    Vector6 aside;
    aside << 0.006, -0.006, 0.006, 0.005, -0.005, 0.005;
    const ImageF image = widened(observe(room(), expSE3(aside) * kPose, 0.02), 4.);
    for (const double gain : {0.8, 1., 1.2}) {
        EXPECT_NEAR(fittedGain(exposed(image, gain), viewOfRoom(), 1.), gain, 0.01);
    }
}

/// Or the gains of a thousand images would drift.
TEST(FittedGain, StaysAsItIsByChance) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20; ++i) {
        const ImageF image = test::noisy(viewOfRoom().intensity, 0.02, random);
        EXPECT_EQ(fittedGain(exposed(image, 1.1), viewOfRoom(), 1.1), 1.1) << i;
    }
}

TEST(FittedGain, IsThatOfTheUnchangedPartOfAScene) {
    ImageF image = exposed(observe(room(), kPose, 0.01), 1.2);
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < image.getWidth() / 4; ++u) image[v][u] = 0.9F;
    }
    EXPECT_NEAR(fittedGain(image, viewOfRoom(), 1.), 1.2, 0.03);
}

TEST(FittedGain, IsTheLastOneWhereNothingCanBeCompared) {
    View hole = viewOfRoom();
    hole.depth = 0.F;
    EXPECT_EQ(fittedGain(viewOfRoom().intensity, hole, 1.3), 1.3);
    ImageF white = viewOfRoom().intensity;
    white = 1.F;  // clipped
    EXPECT_EQ(fittedGain(white, viewOfRoom(), 1.3), 1.3);
}

/// A gain of a tenth: the image shows something else.
TEST(FittedGain, IsTheLastOneIfTheImageShowsSomethingElse) {
    EXPECT_EQ(fittedGain(exposed(viewOfRoom().intensity, 0.1), viewOfRoom(), 1.), 1.);
}

TEST(FittedGain, RefusesImagesOfAnotherSize) {
    EXPECT_THROW(fittedGain(ImageF(10, 10, 0.5F), viewOfRoom(), 1.), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
