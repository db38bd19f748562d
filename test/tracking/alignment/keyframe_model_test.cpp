// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/keyframe_model.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/constants.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::errorOf;

const Camera& wideCamera() {
    static const Camera half = makeCamera(320, 240, 1.1);
    return half;
}

View roomView(const Pose& T_c_w, double sigma = 0., std::uint64_t seed = 1) {
    View view;
    test::room().render(wideCamera(), T_c_w, view);
    std::mt19937_64 random(seed);
    if (sigma > 0.) view.intensity = test::noisy(view.intensity, sigma, random);
    return view;
}

const Pose kFirst = lookFrom({1.6, 3., 1.6}, 0.6, 0.1);

TEST(KeyframeModel, FindsTheMotion) {
    std::mt19937_64 random(1);
    for (const int finest : {0, 1}) {
        KeyframeOptions options;
        options.finest = finest;
        KeyframeModel keyframe(roomView(kFirst), wideCamera(), kFirst, options);
        for (int i = 0; i < 5; ++i) {
            const Pose truth = expSE3(test::randomTwist(0.1, 0.06, random)) * kFirst;
            const Alignment a = keyframe.align(roomView(truth).intensity, kFirst);
            EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
            EXPECT_LT(errorOf(a, truth).head<3>().norm(), 2e-3);
            EXPECT_LT(errorOf(a, truth).tail<3>().norm(), 1e-3);
            EXPECT_GT(a.overlap, 0.6);
        }
    }
}

/// At the border of an object before a background without depth, pixels of half the size show both.
/// They would draw the object inward.
TEST(KeyframeModel, BordersOfAnObjectDoNotDisplaceIt) {
    Scene scene;
    const auto texture = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 4}));
    addBox(scene, {2., -0.6, 0.8}, {2.5, 0.1, 1.5}, texture);
    addBox(scene, {2.6, 0.3, 1.1}, {3.1, 0.8, 1.6}, texture);
    const MeshRenderer objects(scene);
    const auto seen = [&](const Pose& T_c_w) {
        View view;
        objects.render(wideCamera(), T_c_w, view);
        for (unsigned i = 0; i < view.depth.getSize(); ++i) {
            if (view.depth.bitmap[i] == 0.F) view.intensity.bitmap[i] = 0.05F;
        }
        return view;
    };
    const Pose first = lookFrom({0.5, 0., 1.3}, 0., 0.05);
    KeyframeModel keyframe(seen(first), wideCamera(), first);
    std::mt19937_64 random(1);
    double sum = 0.;
    for (int i = 0; i < 10; ++i) {
        const Pose truth = expSE3(test::randomTwist(0.03, 0.02, random)) * first;
        const Alignment a = keyframe.align(seen(truth).intensity, first);
        EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
        sum += errorOf(a, truth).head<3>().norm();
    }
    EXPECT_LT(sum / 10., 3e-3);
}

TEST(KeyframeModel, LeavesOutDepthThatBends) {
    View view = roomView(kFirst);
    for (unsigned v = 60; v < 180; ++v) {  // half the image: every other column is too far
        for (unsigned u = 0; u < 320; u += 2) view.depth[v][u] *= 1.024F;
    }
    const Pose truth = lookFrom({1.7, 3.05, 1.6}, 0.6, 0.1);
    const auto distance = [&](double maxBend) {
        KeyframeOptions options;
        options.finest = 0;
        options.maxBend = maxBend;
        KeyframeModel keyframe(view, wideCamera(), kFirst, options);
        return errorOf(keyframe.align(roomView(truth).intensity, kFirst), truth).norm();
    };
    EXPECT_LT(distance(KeyframeOptions().maxBend), 2e-3);
    EXPECT_GT(distance(1e9), 2. * distance(KeyframeOptions().maxBend));
}

TEST(KeyframeModel, EstimatesExposure) {
    KeyframeOptions options;
    options.alignment.exposure = ExposurePrior{};
    KeyframeModel keyframe(roomView(kFirst), wideCamera(), kFirst, options);
    const Pose truth = expSE3(0.05 * Vector6::Unit(1)) * kFirst;
    ImageF image = roomView(truth).intensity;
    for (unsigned i = 0; i < image.getSize(); ++i) image.bitmap[i] = 1.2F * image.bitmap[i] - 0.1F;
    const Alignment a = keyframe.align(image, kFirst);
    EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
    EXPECT_NEAR(a.exposure.gain, 1.2, 0.02);
    EXPECT_NEAR(a.exposure.offset, -0.1, 0.01);
    EXPECT_LT(errorOf(a, truth).norm(), 2e-3);
}

/// Information in the camera frame, whatever the motion: that of the planner at the keyframe,
/// carried over by the adjoint.
TEST(KeyframeModel, InformationIsCarriedToTheCamera) {
    KeyframeOptions options;
    options.finest = 0;
    options.minGradient = 0.;
    options.maxBend = kInfinity;  // the pixels that planning counts
    options.alignment.robust = RobustWeight::none;
    options.alignment.measureCovariance = false;
    const View view = roomView(kFirst);
    KeyframeModel keyframe(view, wideCamera(), kFirst, options);
    const Alignment a = keyframe.align(view.intensity, kFirst);
    const Matrix6 planned =
        photometricInformation(view, wideCamera(), options.alignment.photometric);
    // A border of a pixel and a few points on its edge are looked up outside the image, and
    // gradients seen over one pixel are not quite those of the keyframe over two: a little counts
    // as noise.
    EXPECT_LT((a.information - planned).norm(), 0.1 * planned.norm());

    Vector6 turn = 0.3 * Vector6::Unit(5);
    turn[0] = 0.02;
    const Pose moved = expSE3(turn) * kFirst;
    const Alignment b = keyframe.align(roomView(moved).intensity, moved);
    const Matrix6 Ad = adjoint(kFirst * b.T_c_w.inverse());
    const Matrix6 carried = Ad.transpose() * planned * Ad;
    EXPECT_LT((b.information - carried).norm(), 0.5 * (b.information - planned).norm());
}

View floorView(const Texture& texture, const Pose& T_c_w, std::uint64_t seed) {
    const MeshRenderer floor(test::floorOf(texture));
    View view;
    floor.render(wideCamera(), T_c_w, view);
    std::mt19937_64 random(seed);
    view.intensity = test::noisy(view.intensity, AlignmentOptions().photometric.sigma, random);
    return view;
}

/// The noise of a keyframe has gradients as texture has, and there are many pixels.
TEST(KeyframeModel, NoiseIsNoTexture) {
    const Pose above = lookFrom({0., 0., 1.5}, test::kDown);
    KeyframeModel grey(floorView(uniformTexture(0.5), above, 1), wideCamera(), above);
    const Alignment a = grey.align(floorView(uniformTexture(0.5), above, 2).intensity, above);
    EXPECT_EQ(a.openDirections.size(), 6U) << describe(a);

    const Texture bars = stripes({.width = 0.3, .softEdge = 0.05});
    KeyframeModel striped(floorView(bars, above, 3), wideCamera(), above);
    const Pose moved = expSE3(Vector6(Vector6::Constant(0.01))) * above;
    const Alignment b = striped.align(floorView(bars, moved, 4).intensity, above);
    EXPECT_EQ(b.verdict, Verdict::degenerate) << describe(b);
    EXPECT_LT(b.openDirections.size(), 6U) << describe(b);
    const Vector6 e = errorOf(b, moved);
    EXPECT_LT(squaredDistance(e, b.covariance), 30.) << e.transpose();
}

/// In a simulator without noise, projections of a camera that has not moved can be exact: residuals
/// of zero inform, too.
TEST(KeyframeModel, AnExactFitIsInformative) {
    const Camera camera{256, 256, vpCameraParameters(128., 128., 127.5, 127.5)};
    View view;
    test::room().render(camera, kFirst, view);
    KeyframeModel keyframe(view, camera);
    const Alignment a = keyframe.align(view.intensity, Pose::Identity());
    ASSERT_EQ(a.residual.rms, 0.);
    EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
}

/// What is left of the last pixel must not count where points are padded to whole vectors.
TEST(KeyframeModel, ABrokenPixelHasNoEffect) {
    View view = roomView(kFirst);
    const ImageF image = view.intensity;
    view.intensity[238][318] = std::numeric_limits<float>::quiet_NaN();
    KeyframeOptions options;
    options.finest = 0;
    KeyframeModel keyframe(view, wideCamera(), kFirst, options);
    const Alignment a = keyframe.align(image, kFirst);
    EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
    EXPECT_LT(errorOf(a, kFirst).norm(), 1e-3);
}

TEST(KeyframeModel, ReportsThatItIsLost) {
    KeyframeModel keyframe(roomView(kFirst), wideCamera(), kFirst);
    EXPECT_TRUE(isLost(
        keyframe.align(ImageF(wideCamera().height, wideCamera().width, 0.F), kFirst).verdict));
    const View elsewhere = roomView(lookFrom({4.5, 1., 1.2}, 0.2, 2.5), 0.01);
    EXPECT_TRUE(isLost(keyframe.align(elsewhere.intensity, kFirst).verdict));
    View blind = roomView(kFirst);
    blind.depth = ImageF(wideCamera().height, wideCamera().width, 0.F);
    KeyframeModel noDepth(blind, wideCamera(), kFirst);
    EXPECT_EQ(noDepth.align(blind.intensity, kFirst).verdict, Verdict::lostOverlap);
}

TEST(KeyframeModel, RefusesImagesOfAnotherSize) {
    KeyframeModel keyframe(roomView(kFirst), wideCamera(), kFirst);
    EXPECT_THROW(keyframe.align(ImageF(10, 10), kFirst), std::invalid_argument);
    EXPECT_THROW(KeyframeModel(View{}, wideCamera()), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
