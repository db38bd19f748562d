// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/fitted_exposure.hpp"

#include <gtest/gtest.h>

#include "alignment/image_pyramid.hpp"
#include "tracking/alignment/room_images.hpp"

namespace photonav {
namespace {

using test::camera;
using test::kPose;
using test::observe;
using test::room;

ImageF exposed(ImageF image, double gain, double offset) {
    for (unsigned k = 0; k < image.getSize(); ++k) {
        image.bitmap[k] = static_cast<float>(gain * image.bitmap[k] + offset);
    }
    return image;
}

View viewOfRoom() {
    View view;
    room().render(camera(), kPose, view);
    return view;
}

/// The image is blurred, noisy, and taken a centimetre and half a degree aside.
TEST(FittedExposure, DoesNotDependOnSharpnessNoiseAndSmallErrorsOfThePose) {
    Vector6 aside;
    aside << 0.006, -0.006, 0.006, 0.005, -0.005, 0.005;
    const ImageF image = widened(observe(room(), expSE3(aside) * kPose, 0.02), 4.);
    for (const double gain : {0.8, 1., 1.2}) {
        const Exposure found = fittedExposure(exposed(image, gain, 0.), viewOfRoom(), {});
        EXPECT_NEAR(found.gain, gain, 0.03);
        EXPECT_NEAR(found.gain * 0.5 + found.offset, gain * 0.5, 0.01);
    }
}

/// Or the exposures of a thousand images would drift.
TEST(FittedExposure, StaysAsItIsByChance) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20; ++i) {
        const ImageF image = test::noisy(viewOfRoom().intensity, 0.02, random);
        const Exposure last{1.1, 0.001};
        const Exposure found = fittedExposure(exposed(image, 1.1, 0.001), viewOfRoom(), last);
        EXPECT_EQ(found.gain, last.gain) << i;
        EXPECT_EQ(found.offset, last.offset) << i;
    }
}

TEST(FittedExposure, IsThatOfTheUnchangedPartOfAScene) {
    ImageF image = exposed(observe(room(), kPose, 0.01), 1.2, 0.);
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < image.getWidth() / 4; ++u) image[v][u] = 0.9F;
    }
    EXPECT_NEAR(fittedExposure(image, viewOfRoom(), {}).gain, 1.2, 0.03);
}

TEST(FittedExposure, IsTheLastOneWhereNothingCanBeCompared) {
    const Exposure last{1.3, 0.002};
    View hole = viewOfRoom();
    hole.depth = 0.F;
    EXPECT_EQ(fittedExposure(viewOfRoom().intensity, hole, last).gain, 1.3);
    ImageF white = viewOfRoom().intensity;
    white = 1.F;  // clipped
    EXPECT_EQ(fittedExposure(white, viewOfRoom(), last).gain, 1.3);
}

/// A gain of a tenth is not an exposure: the image shows something else.
TEST(FittedExposure, IsTheLastOneIfTheImageShowsSomethingElse) {
    EXPECT_EQ(fittedExposure(exposed(viewOfRoom().intensity, 0.1, 0.), viewOfRoom(), {}).gain, 1.);
}

TEST(FittedExposure, RefusesImagesOfAnotherSize) {
    EXPECT_THROW(fittedExposure(ImageF(10, 10, 0.5F), viewOfRoom(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
