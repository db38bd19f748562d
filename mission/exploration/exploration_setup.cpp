// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "exploration/exploration.hpp"
#include "io/error.hpp"
#include "map/textured_octree.hpp"
#include "onlinemap/known_map.hpp"
#include "onlinemap/online_map.hpp"
#include "replanning/online_planner.hpp"

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

void checkHeadings(const Config& config) {
    if (config.space == StateKind::se3) {
        throw config.invalid("space", "se3: a robot that explores flies level");
    }
    for (const std::string& name : config.explore.planners) {
        if (explorePlanner(name).headings && config.space != StateKind::positionYaw) {
            throw config.invalid("explore.planners",
                                 fmt::format("{}: the robot's heading is not free", name));
        }
    }
}

ExplorerOptions explorerOf(const Config& config, const FlightOptions& flight,
                           std::shared_ptr<const TexturedOcTree> known, Timing inRealTime) {
    const SimulatedCameraOptions& camera = flight.robot.camera;
    return {.config = config,
            .tracker = flight.tracker,
            .pilot = flight.pilot,
            .timeStep = flight.timeStep,
            .imageAge = 2. * camera.period + camera.latency,
            .bodyRadius = flight.bodyRadius,
            .known = std::move(known),
            .timing = config.explore.realtime ? inRealTime : Timing::byWork};
}

/// A map of its own that the robot cannot make is refused before it takes off.
void checkMap(const ExplorationSetup& setup) {
    const Config& config = setup.config;
    constexpr double kSeenBeyond = 20.;  // what is seen beyond the bounds [m]
    const double farthest = std::max(config.bounds.min().cwiseAbs().maxCoeff(),
                                     config.bounds.max().cwiseAbs().maxCoeff());
    const auto tooFine = [&](const std::string& reason) {
        if (setup.known) return config.invalid("map.file", config.mapFile + ": " + reason);
        return config.invalid("explore.resolution", reason);
    };
    const double reach = kKeyOfZero * config.explore.cell();
    if (farthest + kSeenBeyond > reach) {
        throw tooFine(
            fmt::format("a map of cells of {} m ends {:.0f} m from the origin, the "
                        "bounds at {:.0f} m",
                        config.explore.cell(), reach, farthest));
    }
    try {
        const OnlineMap map(config, setup.known.get());
        Config optimistic = config;
        optimistic.unknownToPlanner = UnknownPolicy::free;
        const World world(map.cells(), map.obstacles(), optimistic);
        const double clearance = world.clearance(config.start.position);
        if (setup.known && clearance < setup.flight.bodyRadius) {
            throw config.invalid(
                "map.file", fmt::format("{}: the start is in an obstacle of this map: clearance "
                                        "{:.3f} m, the body's radius is {} m",
                                        config.mapFile, clearance, setup.flight.bodyRadius));
        }
    } catch (const std::invalid_argument& error) {  // too large a grid for these bounds
        throw tooFine(error.what());
    }
}

/// Surfaces of a known map that lie anywhere in their cells decide how exact the map is.
FlightOptions flightOf(const Config& config, const TexturedOcTree* known) {
    const bool isCoarse = known != nullptr && !known->hasSurfaces();
    return flightOptions(config, isCoarse ? MapKind::cells : MapKind::surfaces,
                         config.explore.cell());
}

/// The config with the size of the cells of a known map.
Config withCellsOf(const TexturedOcTree* known, Config config) {
    if (known != nullptr) config.explore.resolution = known->getResolution();
    return config;
}

/// The kappa of all flights, whose costs are compared: the automatic one is chosen in the map that
/// they begin with.
double kappaOf(const ExplorationSetup& setup) {
    const Config& config = setup.config;
    if (!isAutomatic(config.belief.kappa)) return config.belief.kappa;
    const OnlineMap map(config, setup.known.get());
    return OnlinePlanner(config, map, explorePlanner("belief_rrt_star"), config.seed).kappa();
}

}  // namespace

ExplorerOptions explorerOptions(const Config& given) {
    checkHeadings(given);
    const auto known = loadKnownMap(given);
    const Config config = withCellsOf(known.get(), given);
    return explorerOf(config, flightOf(config, known.get()), known, Timing::realTime);
}

ExplorerOptions explorerOptions(const ExplorationSetup& setup) {
    return explorerOf(setup.config, setup.flight, setup.known, Timing::simulatedRealTime);
}

ExplorationSetup setUpExploration(const PlanningProblem& problem) {
    checkHeadings(problem.config());
    problem.checkPlace("start", problem.config().start);
    const auto known = loadKnownMap(problem.config());
    const Config config = withCellsOf(known.get(), problem.config());
    ExplorationSetup setup{config, setUpFlight(problem).world, flightOf(config, known.get()),
                           known};
    checkMap(setup);
    setup.config.belief.kappa = kappaOf(setup);
    SimulatedCameraOptions& camera = setup.flight.robot.camera;
    camera.depth = depthSensorOf(config.explore.sensor);
    camera.depthNoise = {config.explore.depthSigma, config.explore.depthMissing};
    camera.baseline = config.explore.baseline;
    camera.projector = config.explore.projector;
    camera.verticalSigma = config.explore.verticalSigma;
    setup.flight.robot.body.gyroscopeNoise = config.explore.gyroscopeNoise;
    setup.flight.arrivalTolerance = config.explore.goalTolerance;
    PhotometricOptions ofSensor = config.photometric;
    ofSensor.scale = 1.;
    camera.stereo.noise = config.photometric.sigma;
    camera.pairNoise = config.fly.camera == "real" ? realNoise() : assumedNoise(ofSensor);
    return setup;
}

}  // namespace photonav
