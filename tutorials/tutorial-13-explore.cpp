// SPDX-License-Identifier: BSD-3-Clause
// Fly to a goal in a room that the robot has never seen: its own camera makes the map, and the plan
// is repaired whenever an obstacle comes into view.
#include <cmath>
#include <cstdio>

#include "exercises.hpp"
#include "exploration/exploration.hpp"
#include "figures/images.hpp"
#include "long_room.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

using namespace photonav;

namespace {

/// 8 m long, with a box as high as the room between start and goal.
Scene room() {
    return longRoom(
        3., Eigen::AlignedBox3d(Eigen::Vector3d(4.5, 1.4, 0.), Eigen::Vector3d(5., 2.6, 3.)));
}

/// Camera 45 degrees down.
Config flightThrough() {
    Config config = flightThroughLongRoom("front45");
    config.belief.kappa = 2.5;
    config.explore.range = 3.;
    return config;
}

Plot::Points fromAbove(const std::vector<FlightSample>& samples) {
    Plot::Points way;
    for (const FlightSample& s : samples) {
        way.emplace_back(s.T_c_w.inverse().translation().head<2>());
    }
    return way;
}

/// The map that the robot made, and its way.
Plot drawMap(const ExplorationResult& flight, const Config& config) {
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-0.2, -0.2), Eigen::Vector2d(8.2, 4.2));
    Plot plot = Plot::map(area, 640.);
    const World map(flight.map, config);
    plot.picture(greyPicture(map.pictureFromAbove(area, 1.4, 0.05)), area, false);
    plot.curve(
        fromAbove(flight.samples),
        {.color = plannerColor(flight.planner), .width = 3., .name = "path flown", .halo = 1.});
    plot.marker(config.start.position.head<2>(), kStartColor, "start");
    plot.marker(config.goal.position.head<2>(), kGoalColor, "goal");
    return plot;
}

/// The standard deviation of the position that the robot believes, and its true error [mm].
Eigen::Vector2d errorsOf(const FlightSample& s) {
    const Eigen::Vector3d off =
        s.belief.mean.inverse().translation() - s.T_c_w.inverse().translation();
    return 1e3 * Eigen::Vector2d(std::sqrt(s.belief.covariance.topLeftCorner<3, 3>().trace()),
                                 off.norm());
}

/// What the robot believes its error to be, and what it is.
Plot drawErrors(const std::vector<FlightSample>& samples) {
    Plot plot;
    plot.width = 640.;
    plot.x = {.min = 0., .label = "path flown [m]"};
    plot.y = {.min = 0., .label = "position error [mm]"};
    Plot::Points believed, actual;
    for (const FlightSample& s : samples) {
        believed.emplace_back(s.distance, errorsOf(s)[0]);
        actual.emplace_back(s.distance, errorsOf(s)[1]);
    }
    plot.curve(believed, {.color = kInk, .width = 3., .name = "believed σ"});
    plot.curve(actual, {.color = kWine, .name = "true error"});
    return plot;
}

/// What odometry alone would believe at the goal of the straight way, where no image informs: its
/// standard deviation of the position [mm].
double odometryAlone(Config config) {
    Scene scene;
    addPlane(scene, {0., 0., 0.}, {8., 0., 0.}, {0., 4., 0.},
             addTexture(scene, uniformTexture(0.5)));
    config.belief.initialCovariance = config.explore.initialCovariance;
    const World world(std::move(scene), config);
    PlanningProblem problem(config, world);
    const EvaluatedPath way = problem.evaluate("straight", {config.start, config.goal});
    return 1e3 * std::sqrt(way.points.back().covariance.topLeftCorner<3, 3>().trace());
}

/// From a place beside the box, past its corner: a tangent of the circle about the corner, and the
/// arc up to where the way is parallel to the box [m].
double towardsTheBox(const Eigen::Vector2d& corner, double radius) {
    const double distance = corner.norm();
    const double turned = std::atan2(corner.y(), corner.x()) + std::asin(radius / distance);
    return std::sqrt(distance * distance - radius * radius) + radius * turned;
}

/// Neither answer depends on how the exploration went.
std::vector<Exercise> exercises(const Config& config) {
    const double radius = config.robotRadius;
    return {{[&] { return odometryAlone(config); }, 0.05},
            {[=] {
                 return towardsTheBox({3.5, 0.6}, radius) + 0.5 + towardsTheBox({2., 0.6}, radius);
             },
             0.005}};
}

}  // namespace

int main(int argc, char** argv) {
    if (const auto code = checkAnswers(argc, argv, exercises(flightThrough()))) return *code;
    //! [explore]
    const Config config = flightThrough();
    const World truth(room(), config);  // that the robot does not know
    const PlanningProblem problem(config, truth);
    std::puts("  time  cells mapped  edges blocked  path to go");
    const auto onUpdate = [](const ExplorationResult& soFar) {
        const PlanUpdate& update = soFar.updates.back();
        std::printf("%4.1f s  %12zu  %13zu  %7.2f m\n", update.time, soFar.map->size(),
                    update.counts.edgesInvalidated, update.length);
    };
    const ExplorationResult flight = explore(setUpExploration(problem), "belief_rrt_star", 1,
                                             kNotInterrupted, {.update = onUpdate});
    //! [explore]
    std::printf("%s after %.1f m, %.0f mm from the goal\n", nameOf(flight.end).c_str(),
                flight.flown, 1e3 * flight.goalError);
    Figure{"The robot's own map, and its errors",
           {{drawMap(flight, config)}, {drawErrors(flight.samples)}}}
        .save("explore.png");
    std::puts("wrote explore.png");
    return flight.hasArrived() ? 0 : 1;
}
