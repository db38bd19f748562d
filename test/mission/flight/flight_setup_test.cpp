// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_setup.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

FlightOptions optionsFor(const std::vector<std::string>& settings) {
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", settings);
    const World world(config);
    return setUpFlight(PlanningProblem(config, world)).options;
}

TEST(FlightSetup, FliesUnderTheConditionsOfTheConfig) {
    const FlightOptions options =
        optionsFor({"fly.rate=8", "fly.latency=0.4", "fly.drop=0.1", "fly.blackout=[3, 2]",
                    "fly.speed=0.5", "fly.odometry=4", "seed=7", "robot.radius=0.3"});
    EXPECT_DOUBLE_EQ(options.robot.camera.period, 1. / 8.);
    EXPECT_EQ(options.robot.camera.latency, 0.4);
    EXPECT_EQ(options.robot.camera.dropRate, 0.1);
    EXPECT_EQ(options.robot.camera.blackoutStart, 3.);
    EXPECT_EQ(options.robot.camera.blackoutLength, 2.);
    EXPECT_EQ(options.robot.body.odometryFactor, 4.);
    EXPECT_EQ(options.pilot.servo.maxSpeed, 0.5);
    EXPECT_EQ(options.bodyRadius, 0.15);
    EXPECT_EQ(options.arrivalTolerance, 0.3);
    EXPECT_EQ(options.seed, 7U);
    EXPECT_GE(options.tracker.loss.blindTime, 0.4 + 4. / 8.);
    EXPECT_TRUE(options.tracker.searchPrior);
    EXPECT_TRUE(options.pilot.isFree != nullptr);
}

TEST(FlightSetup, ImagesAreAlignedAsTheCameraTakesThem) {
    const AlignmentOptions assumed = optionsFor({}).tracker.map;
    const AlignmentOptions real = optionsFor({"fly.camera=real", "camera.blur=0.4"}).tracker.map;
    EXPECT_TRUE(assumed.measureCovariance && real.measureCovariance);
    EXPECT_FALSE(assumed.exposure.has_value());
    EXPECT_TRUE(real.exposure.has_value());
    EXPECT_EQ(assumed.blur, kAreaBlur);
    EXPECT_GT(real.blur, 0.4);  // and its defocus
    EXPECT_EQ(assumed.informationFactor, 1.);
    EXPECT_EQ(optionsFor({"fly.scale=0.5"}).tracker.map.informationFactor, 0.5);
}

TEST(FlightSetup, ACalibrationCountsCorrelatedImagesOnce) {
    FlyConfig fly;
    applyCalibration({.scale = 0.2, .floorTranslation = 0.01, .correlationTime = 4.}, fly);
    EXPECT_DOUBLE_EQ(fly.scale.value(), 0.05);
    EXPECT_EQ(fly.floorTranslation, 0.01);
    EXPECT_EQ(fly.floorRotation, 0.);
}

}  // namespace
}  // namespace photonav
