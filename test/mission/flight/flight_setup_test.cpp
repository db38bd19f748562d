// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_setup.hpp"

#include <gtest/gtest.h>

#include "io/error.hpp"
#include "map/octree_file.hpp"
#include "temporary_folder.hpp"

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
                    "fly.speed=0.5", "fly.turn_rate=0.7", "fly.odometry=4", "fly.lag=0.1",
                    "fly.drift=0.05", "seed=7", "robot.radius=0.3"});
    EXPECT_DOUBLE_EQ(options.robot.camera.period, 1. / 8.);
    EXPECT_EQ(options.robot.camera.latency, 0.4);
    EXPECT_EQ(options.robot.camera.dropRate, 0.1);
    EXPECT_EQ(options.robot.camera.blackoutStart, 3.);
    EXPECT_EQ(options.robot.camera.blackoutLength, 2.);
    EXPECT_EQ(options.robot.body.odometryFactor, 4.);
    EXPECT_EQ(options.robot.body.lag, 0.1);
    EXPECT_EQ(options.robot.body.drift, 0.05);
    EXPECT_EQ(options.pilot.route.limits.maxSpeed, 0.5);
    EXPECT_EQ(options.pilot.route.limits.maxYawRate, 0.7);
    EXPECT_EQ(options.bodyRadius, 0.15);
    EXPECT_EQ(options.arrivalTolerance, 0.3);
    EXPECT_EQ(options.seed, 7U);
    EXPECT_GE(options.tracker.loss.blindTime, 0.4 + 4. / 8.);
    EXPECT_TRUE(options.tracker.searchPrior);
    EXPECT_EQ(options.pilot.radius, 0.3);
    EXPECT_EQ(options.pilot.bodyRadius, 0.15);
}

TEST(FlightSetup, ImagesAreAlignedAsTheCameraTakesThem) {
    const AlignmentOptions assumed = optionsFor({}).tracker.map;
    const AlignmentOptions real = optionsFor({"fly.camera=real", "camera.blur=0.4"}).tracker.map;
    EXPECT_TRUE(assumed.measureCovariance && real.measureCovariance);
    EXPECT_FALSE(assumed.exposure.has_value());
    EXPECT_TRUE(real.exposure.has_value());
    EXPECT_EQ(assumed.blur, kAreaBlur);
    EXPECT_GT(real.blur, 0.4);  // and its defocus
    EXPECT_EQ(optionsFor({"camera.blur=0.4"}).robot.camera.blur, 0.4);
    EXPECT_EQ(assumed.informationScale, 1.);
    EXPECT_EQ(optionsFor({"fly.scale=0.5"}).tracker.map.informationScale, 0.5);
}

TEST(FlightSetup, BodyAndToleranceAreThoseOfTheRobotUnlessGiven) {
    const FlightOptions small = optionsFor({"robot.radius=0.05", "fly.body_radius=0.04"});
    EXPECT_EQ(small.bodyRadius, 0.04);
    EXPECT_EQ(small.arrivalTolerance, 0.1);
    const FlightOptions usual = optionsFor({});
    EXPECT_EQ(usual.robot.camera.period, 0.25);  // a view every planner.ds, at full speed
    EXPECT_EQ(usual.pilot.photometricGoal, true);
    EXPECT_EQ(optionsFor({"fly.photometric_goal=false"}).pilot.photometricGoal, false);
    EXPECT_EQ(usual.tracker.map.trust.leastSigma, 0.);
    const AlignmentOptions bounded =
        optionsFor({"fly.least_sigma=0.02", "fly.least_sigma_rotation=0.01"}).tracker.map;
    EXPECT_EQ(bounded.trust.leastSigma, 0.02);
    EXPECT_EQ(bounded.trust.leastSigmaRotation, 0.01);
}

/// The surfaces of a map err by parts of a cell.
TEST(FlightSetup, AlignmentsGoByTheKindOfMap) {
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml",
                                     {"camera.blur=0.4", "camera.stride=2"});
    const AlignmentOptions mesh = flightAlignment(config, MapKind::mesh, 0.);
    const AlignmentOptions cells = flightAlignment(config, MapKind::cells, 0.1);
    const AlignmentOptions surfaces = flightAlignment(config, MapKind::surfaces, 0.1);
    EXPECT_EQ(mesh.modelErrors.surface, 0.);
    EXPECT_NEAR(cells.modelErrors.surface, 0.058, 1e-9);
    EXPECT_NEAR(surfaces.modelErrors.surface, 0.01, 1e-9);
    EXPECT_EQ(mesh.modelNoise, ModelNoise::none);
    EXPECT_EQ(surfaces.modelNoise, ModelNoise::inPose);
    EXPECT_EQ(mesh.blur, 0.4);
    EXPECT_EQ(mesh.cellSize, 0.);  // else images are compared as they are
    EXPECT_EQ(cells.cellSize, 0.1);
    EXPECT_EQ(mesh.photometric.stride, 1);  // whatever that of the planner is
}

/// A floor of 4 x 4 cells.
std::string mapFile(const test::TemporaryFolder& folder) {
    TexturedOcTree map(0.25);
    for (double x = 0.1; x < 1.; x += 0.25) {
        for (double y = 0.1; y < 1.; y += 0.25) map.updateNode(x, y, 0.1, true);
    }
    saveTexturedOcTree(map, folder.file("map.ot"));
    return folder.file("map.ot");
}

TEST(FlightSetup, AMapToTrackInIsNotTheWorldFlownIn) {
    const test::TemporaryFolder folder;
    Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", {"seed=7"});
    const World world(config);
    const FlightSetup known = setUpFlight(PlanningProblem(config, world));
    EXPECT_EQ(known.world.map, world.sharedViews());
    EXPECT_EQ(known.map, MapKind::mesh);
    EXPECT_EQ(known.world.clearance(config.start.position), world.clearance(config.start.position));

    config.fly.map = mapFile(folder);
    const FlightSetup mapped = setUpFlight(PlanningProblem(config, world));
    EXPECT_EQ(mapped.world.truth, world.sharedViews());
    EXPECT_NE(mapped.world.map, world.sharedViews());
    EXPECT_EQ(mapped.map, MapKind::cells);
    EXPECT_NEAR(mapped.options.tracker.map.modelErrors.surface, 0.58 * 0.25, 1e-9);
    // It may be made of the images of flights with the same seeds.
    EXPECT_NE(mapped.options.seed, known.options.seed);

    config.fly.map = folder.file("missing.ot");
    EXPECT_THROW(setUpFlight(PlanningProblem(config, world)), InputError);
}

TEST(FlightSetup, ThePilotKnowsTheClearanceOfThePlan) {
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/kitchen.yaml");
    const World world(config);
    const FlightSetup setup = setUpFlight(PlanningProblem(config, world));
    for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d p_w = config.bounds.sample();
        EXPECT_EQ(setup.options.pilot.clearance(p_w), world.clearance(p_w));
    }
}

TEST(FlightSetup, ACalibrationCountsCorrelatedImagesOnce) {
    FlyConfig fly;
    applyCalibration({.scale = 0.2, .leastSigma = 0.01, .correlationTime = 4.}, fly);
    EXPECT_DOUBLE_EQ(fly.scale.value(), 0.05);
    EXPECT_EQ(fly.leastSigma, 0.01);
    EXPECT_EQ(fly.leastSigmaRotation, 0.);
}

}  // namespace
}  // namespace photonav
