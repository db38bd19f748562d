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
                 "of the camera, at most one image per step of 20 ms; 0: a view every `planner.ds` "
                 "at full speed"},
                c.rate, {0., 50.});
    keys.number({"latency", "s", "of images"}, c.latency, {0., 10.});
    keys.number({"drop", "", "share of the images that never arrive"}, c.drop, {0., 1.});
    keys.number({"black", "", "share of the images that are black"}, c.black, {0., 1.});
    keys.add({.words = {"blackout", "s", "all images are black: from this time on, for so long"},
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
    keys.choice({"camera", "", "image noise: as planned with, or that of a real camera"}, c.camera,
                {"assumed", "real"});
}

}  // namespace

void addKeys(KeyTable& keys, FlyConfig& c) {
    keys.beginSection("fly");
    keys.file({"plan", "", "`result.json` of a plan to fly; none: plan anew"}, c.plan);
    keys.file({"map", "", "map, mesh or scene file to track in; none: the true world"}, c.map);
    keys.count({"flights", "", "per planner"}, c.flights, {1., 1e6});
    keys.number({"speed", "m/s", "largest"}, c.speed, {0.01, 100.});
    addImages(keys, c);
    keys.number({"odometry", "", "true odometry variance divided by the assumed one"}, c.odometry,
                {0., 1e6});
    keys.number({"body_radius", "m",
                 "of the body in collisions; 0: half of `robot.radius`, the rest is margin"},
                c.bodyRadius, {0., 1e3});
    keys.flag({"photometric_goal", "", "servo on the goal's image at the end"}, c.photometricGoal);
    keys.number(
        {"scale", "", "factor on the information that the residuals of an image say; none: 1"},
        c.scale, {1e-12, 1e12});
    keys.number({"least_sigma", "m", "least standard deviation of an aligned position; none: 0"},
                c.leastSigma, {0., 1e3});
    keys.number({"least_sigma_rotation", "rad", "the same of an aligned rotation"},
                c.leastSigmaRotation, {0., 1e3});
}

}  // namespace photonav
