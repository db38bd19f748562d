// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/map_noise.hpp"

#include <gtest/gtest.h>

#include "tracking/rooms.hpp"

namespace photonav {
namespace {

constexpr double kSigma = 0.02;

/// The floor from above: an image, and a view of the map that another image left.
struct NoisyFloor {
    explicit NoisyFloor(const Texture& texture) {
        MeshRenderer(test::floorOf(texture))
            .render(camera, lookFrom({0., 0., 2.}, test::kDown), map);
        std::mt19937_64 random(1);
        image = test::noisy(map.intensity, kSigma, random);
        map.intensity = test::noisy(map.intensity, kSigma, random);
    }

    Camera camera = makeCamera(94, 60, 1.2);
    View map;
    ImageF image;
};

/// A blank floor, mapped by noisy images, has gradients as well.
TEST(MapNoise, DistinguishesNoiseFromTexture) {
    const auto informationOf = [&](const Texture& texture) {
        const NoisyFloor floor(texture);
        MapNoise noise;
        const InformationModel model = noise.model(floor.camera, {});
        const Matrix6 before = model(floor.map);
        noise.observe(floor.map, floor.image, floor.camera);
        return std::pair(before.trace(), model(floor.map).trace());
    };
    const auto blank = informationOf(uniformTexture(0.5));
    EXPECT_LT(blank.second, 1e-3 * blank.first);
    const auto rich = informationOf(valueNoise({.size = {20., 20.}, .seed = 3}));
    EXPECT_GT(rich.second, 0.3 * rich.first);
}

/// Of a central difference, half the variance of a pixel.
TEST(MapNoise, IsTheVarianceOfTheMapsGradients) {
    for (const Texture& texture :
         {uniformTexture(0.5), valueNoise({.size = {20., 20.}, .seed = 3})}) {
        const NoisyFloor floor(texture);
        MapNoise noise;
        EXPECT_EQ(noise.variance(), 0.);
        for (int i = 0; i < 3; ++i) noise.observe(floor.map, floor.image, floor.camera);
        const double expected = floor.camera.fx() * floor.camera.fy() * 0.5 * kSigma * kSigma;
        EXPECT_NEAR(noise.variance(), expected, 0.15 * expected);
    }
}

TEST(MapNoise, IsNotMeasuredWhereTheMapShowsLittle) {
    NoisyFloor floor(uniformTexture(0.5));
    for (unsigned v = 10; v < floor.camera.height; ++v) {
        for (unsigned u = 0; u < floor.camera.width; ++u) floor.map.depth[v][u] = 0.F;
    }
    MapNoise noise;
    noise.observe(floor.map, floor.image, floor.camera);
    EXPECT_EQ(noise.variance(), 0.);
}

TEST(MapNoise, IsNeverNegative) {
    NoisyFloor floor(valueNoise({.size = {20., 20.}, .seed = 3}));
    for (unsigned i = 0; i < floor.image.getSize(); ++i) floor.image.bitmap[i] *= 2.F;
    MapNoise noise;
    noise.observe(floor.map, floor.image, floor.camera);
    EXPECT_EQ(noise.variance(), 0.);
}

}  // namespace
}  // namespace photonav
