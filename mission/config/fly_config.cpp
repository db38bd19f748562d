// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "config/config_keys.hpp"
#include "geometry/constants.hpp"

namespace photonav {
namespace {

constexpr double kLatest = 1e6;  // [s]

/// When and how images arrive.
void addImages(KeyTable& keys, FlyConfig& c) {
    keys.number({"rate", "Hz",
                 "images per second, at most one per step of 20 ms; 0: one image every "
                 "`planner.ds` at full speed"},
                c.rate, {0., 50.});
    keys.number({"latency", "s", "delay of the images"}, c.latency, {0., 10.});
    keys.number({"drop", "", "share of the images that never arrive"}, c.drop, {0., 1.});
    keys.number({"black", "", "share of the images that are black"}, c.black, {0., 1.});
    keys.add(
        {.words = {"blackout", "s", "start and length of a time in which all images are black"},
         .allowed = "`[start, length]`",
         .read =
             [&c](YamlMap& map) {
                 map.readVector("blackout", c.blackout);
                 if ((c.blackout.array() < 0.).any()) map.fail("blackout", "negative time");
                 if ((c.blackout.array() > kLatest).any()) {
                     map.fail("blackout", fmt::format("time beyond {} s", kLatest));
                 }
             },
         .value =
             [&c] {
                 return yamlList(std::vector{c.blackout[0], c.blackout[1]});
             }});
    keys.choice({"camera", "",
                 "image noise: `assumed`, the noise that the planner assumes, or `real`, "
                 "the noise of a real camera"},
                c.camera, {"assumed", "real"});
}

}  // namespace

void addKeys(KeyTable& keys, FlyConfig& c) {
    keys.beginSection("fly");
    keys.file({"plan", "", "`result.json` of a plan to fly; none: plan anew"}, c.plan);
    keys.file({"map", "", "map, mesh or scene file to track in; none: the true world"}, c.map);
    keys.count({"flights", "", "flights per planner"}, c.flights, {1., 1e6});
    keys.number({"speed", "m/s", "largest speed"}, c.speed, {0.01, 100.});
    keys.number({"turn_rate", "rad/s", "largest turn rate (yaw)"}, c.turnRate, {0.01, 100.});
    addImages(keys, c);
    keys.number({"lag", "s", "time constant of the velocity's response to commands"}, c.lag,
                {0., 10.});
    keys.number({"drift", "m/s",
                 "standard deviation, per axis, of a velocity that the commands do not remove, "
                 "such as by wind"},
                c.drift, {0., 10.});
    keys.number({"odometry", "", "true odometry variance divided by the assumed one"}, c.odometry,
                {0., 1e4});
    keys.number({"body_radius", "m",
                 "radius of the body in collisions; 0: half of `robot.radius`, the other "
                 "half is margin"},
                c.bodyRadius, {0., 1e3});
    keys.flag({"photometric_goal", "", "at the end, servo on the image of the goal"},
              c.photometricGoal);
    keys.number({"scale", "", "factor on the information of an alignment; none: 1"}, c.scale,
                {1e-12, 1e12});
    keys.number({"least_sigma", "m", "least standard deviation of an aligned position; none: 0"},
                c.leastSigma, {0., 1.});
    keys.number(
        {"least_sigma_rotation", "rad", "least standard deviation of an aligned rotation; none: 0"},
        c.leastSigmaRotation, {0., 1.});
}

}  // namespace photonav
