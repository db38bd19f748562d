// SPDX-License-Identifier: BSD-3-Clause
// How much blurrier an image is than the views of the model.
#include <gtest/gtest.h>

#include "alignment/image_pyramid.hpp"
#include "estimation/calibration.hpp"
#include "render/area_sensor.hpp"
#include "tracking/alignment/room_images.hpp"

namespace photonav {
namespace {

Alignment alignedWithBlur(double variance, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const View sharp = test::photographed(test::room(), test::camera(), test::kPose);
    const ImageF image = test::noisy(widened(sharp.intensity, variance), 0.01, random);
    DenseAligner aligner(test::room(), test::camera(), photographOptions(kAreaBlur));
    const Pose start = expSE3(test::randomTwist(0.02, 0.01, random)) * test::kPose;
    return aligner.align(image, start);
}

TEST(ImageBlur, IsFoundFromTheResiduals) {
    for (const double variance : {0., 0.3, 1.}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const Alignment a = alignedWithBlur(variance, seed);
            ASSERT_EQ(a.verdict, Verdict::converged) << describe(a);
            EXPECT_LT(a.blurSigma, kBlurError);
            EXPECT_NEAR(a.blur, variance, 2. * std::hypot(kBlurError, a.blurSigma)) << seed;
        }
    }
}

TEST(ImageBlur, IsNotFoundWhereNothingHasAnEdge) {
    const MeshRenderer white(test::floorOf(uniformTexture(0.9)));
    DenseAligner aligner(white, test::camera(), photographOptions(kAreaBlur));
    const Pose pose = lookFrom({0., 0., 2.}, test::kDown);
    EXPECT_GT(aligner.align(test::observe(white, pose, 0.02), pose).blurSigma, 10.);
}

TEST(ImageBlur, BeforeHalvingIsTheInverse) {
    for (const double blur : {0.3, 0.7, 1.5}) {
        const double after = blurAfterHalving(blur);
        EXPECT_NEAR(blurVarianceBeforeHalving(after * after), blur * blur, 1e-12);
    }
}

}  // namespace
}  // namespace photonav
