// SPDX-License-Identifier: BSD-3-Clause
#include "replay/depth_sensor.hpp"

#include <cmath>
#include <random>

#include "mission/replay/replay_fixture.hpp"
#include "replay/replay.hpp"

namespace photonav {
namespace {

/// A floor and a wall seen at a slant, depth rounded to steps, with noise that grows with depth
/// squared.
ImageF slantedDepth(double step, double noiseAtOneMetre, double nearest = 1.) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0., noiseAtOneMetre);
    ImageF depth(120, 188);
    for (unsigned v = 0; v < depth.getHeight(); ++v) {
        for (unsigned u = 0; u < depth.getWidth(); ++u) {
            const double wall = 0.9 - 0.003 * u, floor = 0.3 + 0.004 * v;
            const double z = nearest / std::max(wall, floor);
            depth[v][u] = static_cast<float>(step * std::round((z + noise(random) * z * z) / step));
        }
    }
    return depth;
}

DepthNoise noiseOf(const ImageF& depth) {
    DepthNoise noise;
    noise.add(depth);
    return noise;
}

TEST(DepthNoise, IsThatOfTheSensorWhateverTheSurfaces) {
    EXPECT_NEAR(noiseOf(slantedDepth(1e-4, 1e-3)).atOneMetre(), 1e-3, 1e-4);
    EXPECT_NEAR(noiseOf(slantedDepth(1e-4, 3e-3)).atOneMetre(), 3e-3, 3e-4);
    EXPECT_NEAR(noiseOf(slantedDepth(1e-4, 1e-3, 2.5)).atOneMetre(), 1e-3, 1e-4);
    EXPECT_LT(noiseOf(slantedDepth(2e-4, 0.)).atOneMetre(), 1e-4);
    EXPECT_EQ(DepthNoise().atOneMetre(), 0.);
}

DepthError errorOf(const ImageF& depth, double step, std::optional<double> said = {}) {
    Recording recording;
    recording.sequence.depthScale = 1. / step;
    recording.sequence.depthError = said;
    recording.sequence.frames.resize(1);
    recording.sequence.frames[0].depthFile = "depth.png";
    return depthErrorOf(recording, noiseOf(depth));
}

TEST(DepthError, OfASensorIsAssumedWhereTheRecordingDoesNotSay) {
    EXPECT_EQ(errorOf(slantedDepth(1e-3, 1e-3), 1e-3).relative, 0.1);
    EXPECT_TRUE(errorOf(slantedDepth(1e-3, 1e-3), 1e-3).isAssumed);
    EXPECT_EQ(errorOf(slantedDepth(1e-3, 1e-3), 1e-3, 0.02).relative, 0.02);
    EXPECT_FALSE(errorOf(slantedDepth(1e-3, 1e-3), 1e-3, 0.).isAssumed);
}

TEST(DepthError, OfRenderedDepthIsNoneHoweverCoarselyItIsRounded) {
    for (const double step : {2e-4, 1e-3, 5e-3}) {
        for (const double nearest : {0.5, 1., 4.}) {
            EXPECT_EQ(errorOf(slantedDepth(step, 0., nearest), step).relative, 0.)
                << step << " at " << nearest;
        }
    }
}

using test::ReplayFixture;

TEST_F(ReplayFixture, RenderedDepthIsTakenAsExact) {
    const Replay replay(options);
    EXPECT_TRUE(replay.depthError().isAssumed);
    EXPECT_EQ(replay.depthError().relative, 0.);
}

}  // namespace
}  // namespace photonav
