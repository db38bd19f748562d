// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/repeated_texture.hpp"

#include <gtest/gtest.h>

#include "alignment/wide_aligner.hpp"
#include "estimation/calibration.hpp"
#include "geometry/gaussian.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;
using test::kOblique;

const Camera kCamera = makeCamera(188, 120, 1.2217);
constexpr double kNoise = 0.02;
constexpr double kScale = 0.08;
constexpr double kWeight = kScale / (kNoise * kNoise);

UncertainPose afterOdometry(const Pose& T_c_w) {
    Vector6 sigmas;
    sigmas << 0.016, 0.016, 0.016, 0.003, 0.008, 0.008;
    return {T_c_w, sigmas.cwiseAbs2().asDiagonal()};
}

/// Twists of a camera with its prior's standard deviations divided by `narrower`, x to the right.
std::vector<Vector6> repetitionsAbove(Texture texture, double narrower = 0.5) {
    const MeshRenderer floor(test::floorOf(std::move(texture)));
    UncertainPose prior = afterOdometry(lookFrom({0.2, -0.2, 2.}, kDown, kDown));
    prior.covariance /= narrower * narrower;
    View view;
    floor.render(kCamera, prior.mean, view);
    return repetitions(view, prior.mean, prior, kCamera, kWeight);
}

StripeOptions books(double contrast = 0.6) {
    return {.width = 0.035,
            .softEdge = 0.01,
            .dark = 0.5 - 0.5 * contrast,
            .light = 0.5 + 0.5 * contrast,
            .texel = 0.0025};
}

/// A dark and a light bar are 70 mm, 4.7 pixels at 2 m: the image moves by as much to either side.
TEST(RepeatedTexture, BarsRepeatAtTheirPeriod) {
    const auto twists = repetitionsAbove(stripes(books()));
    const double period = 0.07 * kCamera.fx() / 2.;
    bool isLeft = false, isRight = false;
    for (const Vector6& xi : twists) {
        const double pixels = kCamera.fx() * (0.5 * xi[0] + xi[4]);  // in the middle
        EXPECT_GT(std::abs(pixels), 0.5 * period) << xi.transpose();
        isLeft |= std::abs(pixels + period) < 1.;
        isRight |= std::abs(pixels - period) < 1.;
    }
    EXPECT_TRUE(isLeft && isRight);
}

TEST(RepeatedTexture, NoiseDoesNotRepeat) {
    EXPECT_TRUE(repetitionsAbove(valueNoise({.size = {20., 20.}, .seed = 3})).empty());
}

TEST(RepeatedTexture, NotFartherThanThePriorReaches) {
    EXPECT_TRUE(repetitionsAbove(stripes(books()), 4.).empty());
}

TEST(RepeatedTexture, BarsFainterThanTheNoiseHoldNoAlignment) {
    EXPECT_TRUE(repetitionsAbove(stripes(books(0.005))).empty());
}

/// A shelf on a floor that shows little else, in an image after some odometry. Alignments end at
/// the next book now and then: coarse levels average books away, and the rest of the image does
/// not tell them apart well enough. At the right one the image fits better.
TEST(RepeatedTexture, ABookFartherIsNotAccepted) {
    for (const double end : {0.3, 10.}) {  // in view or not
        Scene scene;
        const auto floor = addTexture(scene, valueNoise({.size = {4., 4.},
                                                         .cells = {1.2, 0.08},
                                                         .amplitudes = {0.03, 0.02},
                                                         .mean = 0.62}));
        addPlane(scene, {-10., -10., 0.}, {20., 0., 0.}, {0., 20., 0.}, floor);
        addBox(scene, {2., -10., 0.}, {2.4, end, 1.9}, addTexture(scene, stripes(books())));
        const MeshRenderer world(scene);
        AlignmentOptions options = photographOptions(kRenderedBlur);
        options.photometric = {.sigma = kNoise, .scale = kScale};
        DenseAligner once(world, kCamera, options);
        WideAligner aligner(world, kCamera, options);
        const UncertainPose prior = afterOdometry(lookFrom({0.2, -0.2, 1.1}, kOblique, 0.1));
        const Matrix6 root = rootOf(prior.covariance);
        std::mt19937_64 random{1};
        int wrongOnce = 0, wrong = 0, found = 0;
        for (int i = 0; i < 30; ++i) {
            const Pose truth = expSE3(draw(root, random)) * prior.mean;
            View view;
            world.render(kCamera, truth, view);
            const ImageF image = test::noisy(view.intensity, kNoise, random);
            const auto isWrong = [&](const Alignment& a) {
                return squaredDistance(test::errorOf(a, truth), a.covariance) > 60.;
            };
            const Alignment a = aligner.align(image, prior);
            wrongOnce += isWrong(once.align(image, prior));
            wrong += isWrong(a);
            found += a.covariance.trace() < 0.5 * prior.covariance.trace();
        }
        EXPECT_GT(wrongOnce, 0) << "too easy";
        EXPECT_EQ(wrong, 0);
        EXPECT_GE(found, 27);
    }
}

}  // namespace
}  // namespace photonav
