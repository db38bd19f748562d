// SPDX-License-Identifier: BSD-3-Clause
#include "config/explore_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "config/config_keys.hpp"
#include "config/explore_planner.hpp"

namespace photonav {
namespace {

void readExplorers(YamlMap& explore, std::vector<std::string>& planners) {
    explore.read("planners", planners);
    for (const std::string& name : planners) {
        try {
            explorePlanner(name);
        } catch (const std::invalid_argument& unknown) {
            explore.fail("planners", unknown.what());
        }
        if (std::ranges::count(planners, name) > 1) explore.fail("planners", name + " twice");
    }
}

/// The sensors, and what of their images is mapped.
void addMappingKeys(KeyTable& keys, ExploreConfig& c) {
    keys.choice({"sensor", "",
                 "sensor that maps: a depth camera, a second camera beside the first, or "
                 "the camera alone, by its own motion"},
                c.sensor, {"depth", "stereo", "monocular"});
    keys.number({"depth_sigma", "m",
                 "standard deviation of the depth camera at 1 m; it grows with depth squared"},
                c.depthSigma, {0., 1.});
    keys.number({"depth_missing", "", "share of the depth camera's pixels without a measurement"},
                c.depthMissing, {0., 1.});
    keys.number({"baseline", "m", "distance between the cameras of `stereo`"}, c.baseline,
                {0.01, 10.});
    keys.number({"projector", "",
                 "infrared projector of `stereo`, whose random dots give texture to uniform "
                 "surfaces: brightness of the dots at 1 m relative to the other light; it falls "
                 "with the square of distance; 0: no projector"},
                c.projector, {0., 100.});
    keys.number({"vertical_sigma", "rad",
                 "standard deviation of the vertical, which the accelerometer measures with every "
                 "image; 0: it is not measured"},
                c.verticalSigma, {0., 1.});
    keys.number(
        {"gyroscope_noise", "rad/sqrt(s)",
         "standard deviation of the rotation that the gyroscope measures over one second, beside "
         "the odometry of `noise.motion`; its square grows with time; 0: no gyroscope"},
        c.gyroscopeNoise, {0., 1.});
    keys.number({"range", "m", "surfaces farther away are not mapped"}, c.range, {0.5, 12.});
    keys.number(
        {"resolution", "m",
         fmt::format("edge of the map's cells; if not given, the edge of a known map's cells "
                     "(`map.file` beside `scene.file`), {} without one",
                     kExploreCell)},
        c.resolution, {kLeastExploreCell, kMostExploreCell});
    keys.choice({"unknown", "",
                 "space that was never seen: `optimistic` plans lead through it, "
                 "`pessimistic` plans do not"},
                c.unknown, {"optimistic", "pessimistic"});
    keys.choice(
        {"unknown_information", "",
         "information of views of space that was never seen: `none` (the paper), "
         "or `predicted`, by the angle to the horizon, from what the view shows beside it and "
         "from the latest views of the flight"},
        c.unknownInformation, {"none", "predicted"});
    keys.choice({"look", "",
                 "where the robot turns to what it has not seen: where its free way ends "
                 "(`stopped`), or already on the way there (`flying`): faster, but with other "
                 "headings than planned, and so less certain. No effect with a camera that looks "
                 "down, and with headings that are fixed or along the motion"},
                c.look, {"stopped", "flying"});
    keys.number(
        {"keyframe_distance", "m", "an image is fused at this distance from the last fused one"},
        c.keyframeDistance, {0.01, 10.});
    keys.number(
        {"keyframe_angle", "rad", "an image is fused after this rotation since the last fused one"},
        c.keyframeAngle, {0.01, 3.2});
    keys.number({"keyframe_new", "",
                 "an image is fused where the map lacks this share of the surfaces in "
                 "view"},
                c.keyframeNew, {0.01, 1.});
}

void addPlanningKeys(KeyTable& keys, ExploreConfig& c) {
    keys.count({"vertices", "",
                "number of vertices of the tree or roadmap, in place of "
                "`planner.vertices`"},
               c.vertices, {2., 1e8});
    keys.count({"shortcut", "",
                "changes that the descent tries on each path, in place of "
                "`planner.shortcut`"},
               c.shortcut, {0., 1e9});
    keys.count({"view_turns", "",
                "every update renders one in `view_turns` of the views that changes of "
                "the map affect, in turn; 1: all of them"},
               c.viewTurns, {1., 1e3});
    keys.number({"commitment", "",
                 "the robot takes another path only if its cost is lower by this share "
                 "(`belief_rrt_star`)"},
                c.commitment, {0., 0.9});
}

/// Flights, when they have arrived, and how many are compared.
void addFlightKeys(KeyTable& keys, ExploreConfig& c) {
    keys.variances({"initial", "m^2, rad^2",
                    "variances at the start, in place of `noise.initial`: an unknown scene has no "
                    "frame but its start"},
                   c.initialCovariance);
    keys.number({"goal_tolerance", "m", "distance to the goal of a flight that arrived"},
                c.goalTolerance, {0.01, 100.});
    keys.number(
        {"goal_confidence", "",
         "the robot reports its arrival if, by its belief, it is within `goal_tolerance` of the "
         "goal with at least this probability"},
        c.goalConfidence, {0., 0.9999});
    keys.number({"time_limit", "s", "longest duration of a flight"}, c.timeLimit, {1., 1e5});
    keys.flag({"realtime", "",
               "the robot flies by the clock while a second thread plans; such flights are not "
               "reproducible"},
              c.realtime);
    keys.count({"trials", "", "flights per planner"}, c.trials, {1., 1e6});
    keys.add({.words = {"planners", "",
                        "planners that are compared; none: `planner.name`. A planner may be "
                        "followed by a policy: headings fixed, `/fixed`, or along the motion, "
                        "`/forward`; a new tree after every change, `/replan`; one plan only, "
                        "`/once`"},
              .read = [&c](YamlMap& map) { readExplorers(map, c.planners); },
              .value = [&c] { return yamlList(c.planners); }});
}

}  // namespace

ExploreConfig::ExploreConfig() : initialCovariance(Matrix6::Zero()) {
    initialCovariance.diagonal() << 1e-6, 1e-6, 1e-6, 1e-8, 1e-8, 1e-8;
}

void addKeys(KeyTable& keys, ExploreConfig& c) {
    keys.beginSection("explore");
    addMappingKeys(keys, c);
    addPlanningKeys(keys, c);
    addFlightKeys(keys, c);
}

}  // namespace photonav
