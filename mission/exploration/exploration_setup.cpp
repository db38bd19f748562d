// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "exploration/exploration.hpp"
#include "io/error.hpp"

namespace photonav {
namespace {

DepthSensor depthSensorOf(ExploreSensor sensor) {
    switch (sensor) {
        case ExploreSensor::depth:
            return DepthSensor::rgbd;
        case ExploreSensor::stereo:
            return DepthSensor::stereo;
        case ExploreSensor::monocular:
            break;
    }
    return DepthSensor::none;
}

}  // namespace

ExplorationSetup setUpExploration(const PlanningProblem& problem) {
    const Config& config = problem.config();
    for (const std::string& name : config.explore.planners) {
        if (explorePlanner(name).headings && config.space != StateKind::positionYaw) {
            throw InputError(config.file, "explore.planners",
                             fmt::format("{}: the robot's heading is not free", name));
        }
    }
    if (!problem.isFlyable(config.start.position)) {
        throw InputError(
            config.file, "start",
            fmt::format("in collision: clearance {:.3f} m, robot.radius {} m",
                        problem.world().clearance(config.start.position), config.robotRadius));
    }
    const FlightSetup flight = setUpFlight(problem);
    ExplorationSetup setup{config, flight.world, flight.options};
    setup.flight.tracker.map =
        flightAlignment(config, MapKind::surfaces, config.explore.resolution);
    SimulatedCameraOptions& camera = setup.flight.robot.camera;
    camera.depth = depthSensorOf(config.explore.sensor);
    camera.depthNoise = {config.explore.depthSigma, config.explore.depthMissing};
    camera.baseline = config.explore.baseline;
    camera.verticalSigma = config.explore.verticalSigma;
    setup.flight.arrivalTolerance = config.explore.goalTolerance;
    PhotometricOptions ofSensor = config.photometric;
    ofSensor.scale = 1.;
    camera.pairNoise = config.fly.camera == "real" ? realNoise() : assumedNoise(ofSensor);
    return setup;
}

}  // namespace photonav
