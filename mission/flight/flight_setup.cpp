// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_setup.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

/// A map may be made of flight 0: its noise must not be that of the images flown by it.
constexpr std::uint64_t kSeedInMaps = 1'000'003;

SimulatedRobotOptions robotOptions(const Config& config) {
    const FlyConfig& fly = config.fly;
    SimulatedRobotOptions robot;
    robot.body.odometryNoise = config.belief.motionNoise;
    robot.body.rotationWeight = config.rotationWeight;
    robot.body.odometryFactor = fly.odometry;
    robot.body.lag = fly.lag;
    robot.body.drift = fly.drift;
    robot.camera.period = fly.rate > 0. ? 1. / fly.rate : config.belief.ds / fly.speed;
    robot.camera.latency = fly.latency;
    robot.camera.dropRate = fly.drop;
    robot.camera.blackRate = fly.black;
    robot.camera.blackoutStart = fly.blackout[0];
    robot.camera.blackoutLength = fly.blackout[1];
    return robot;
}

}  // namespace

FlightOptions flightOptions(const Config& config, MapKind map, double cellSize) {
    const FlyConfig& fly = config.fly;
    FlightOptions flight;
    flight.robot = robotOptions(config);
    flight.tracker.map = flightAlignment(config, map, cellSize);
    flight.robot.camera.blur = flight.tracker.map.blur;
    double& blindTime = flight.tracker.loss.blindTime;
    blindTime = fly.latency + std::max(blindTime, 4. * flight.robot.camera.period);
    flight.pilot.route.limits.maxSpeed = fly.speed;
    flight.pilot.route.limits.maxYawRate = fly.turnRate;
    flight.pilot.photometric = flight.tracker.map.photometric;
    flight.pilot.photometricGoal = fly.photometricGoal;
    flight.bodyRadius = fly.bodyRadius > 0. ? fly.bodyRadius : 0.5 * config.robotRadius;
    flight.pilot.radius = config.robotRadius;
    flight.pilot.bodyRadius = flight.bodyRadius;
    flight.arrivalTolerance = photonav::arrivalTolerance(config);
    flight.seed = config.seed + (fly.map.empty() ? 0 : kSeedInMaps);
    return flight;
}

AlignmentOptions flightAlignment(const Config& config, MapKind map, double cellSize) {
    const FlyConfig& fly = config.fly;
    const bool isReal = fly.camera == "real";
    const double defocus =
        CameraNoiseOptions().blur;  // of the simulated real camera, as calibrated
    AlignmentOptions alignment = isReal ? realCameraOptions(std::hypot(config.camera.blur, defocus))
                                        : photographOptions(config.camera.blur);
    alignment.photometric = config.photometric;
    alignment.photometric.stride = 1;
    alignment.informationScale = fly.scale.value_or(1.);
    alignment.trust.leastSigma = fly.leastSigma.value_or(0.);
    alignment.trust.leastSigmaRotation = fly.leastSigmaRotation.value_or(0.);
    if (map != MapKind::mesh) {
        // Odometry carries what the map's noise leaves open; replays without it would drift there.
        alignment.modelNoise = ModelNoise::inPose;
    }
    alignment.modelErrors.surface = surfaceError(map, cellSize);
    alignment.cellSize = cellSize;
    return alignment;
}

std::vector<PlannedView> plannedViews(std::span<const BeliefPoint> path) {
    std::vector<PlannedView> plan;
    for (const BeliefPoint& point : path) {
        plan.push_back({point.T_w_b, point.covariance, point.length, point.isWaypoint});
    }
    return plan;
}

FlightSetup setUpFlight(const PlanningProblem& problem) {
    const Config& config = problem.config();
    const World& world = problem.world();
    const TrackingMap map =
        config.fly.map.empty() ? TrackingMap{} : loadTrackingMap(config.fly.map);
    FlightSetup setup;
    setup.world = {
        .truth = world.sharedViews(),
        .map = map.views ? map.views : world.sharedViews(),
        .clearance = [&world](const Eigen::Vector3d& p_w) { return world.clearance(p_w); },
        .camera = config.camera.camera(),
        .T_b_c = config.camera.T_b_c(),
        .noise = config.fly.camera == "real" ? realNoise() : assumedNoise(config.photometric)};
    setup.map = map.kind;
    setup.options = flightOptions(config, map.kind, map.resolution());
    setup.options.initialCovariance = problem.initialCovariance();
    setup.options.pilot.clearance = setup.world.clearance;
    return setup;
}

double arrivalTolerance(const Config& config) { return std::max(config.robotRadius, 0.1); }

void applyCalibration(const Calibration& calibration, FlyConfig& fly) {
    fly.scale = calibration.scale / calibration.correlationTime;
    fly.leastSigma = calibration.leastSigma;
    fly.leastSigmaRotation = calibration.leastSigmaRotation;
}

}  // namespace photonav
