// SPDX-License-Identifier: BSD-3-Clause
#include "fly_config.hpp"

#include <fmt/format.h>

#include <cmath>

#include "constants.hpp"

namespace photonav {

FlyConfig readFly(YamlMap& root) {
    FlyConfig config;
    YamlMap fly = root.map("fly");
    fly.read("plan", config.plan);
    double flights = config.flights;
    fly.readNumber("flights", flights, 1., 1e6);
    if (flights != std::floor(flights)) fly.fail("flights", "not a whole number");
    config.flights = static_cast<unsigned>(flights);
    fly.readNumber("speed", config.speed, 0.01, 100.);
    fly.readNumber("rate", config.rate, 0., 50.);
    fly.readNumber("latency", config.latency, 0., 10.);
    fly.readNumber("drop", config.drop, 0., 1.);
    fly.readNumber("black", config.black, 0., 1.);
    fly.readVector("blackout", config.blackout);
    if ((config.blackout.array() < 0.).any()) fly.fail("blackout", "negative time");
    fly.readChoice("camera", config.camera, {"assumed", "real"});
    fly.readNumber("odometry", config.odometry, 0., 1e6);
    fly.readNumber("body_radius", config.bodyRadius, 0., 1e3);
    fly.read("photometric_goal", config.photometricGoal);
    fly.read("map", config.map);
    const auto optional = [&](const char* key, std::optional<double>& value, double least) {
        if (fly.has(key)) fly.readNumber(key, value.emplace(), least, kInfinity);
    };
    optional("scale", config.scale, 1e-12);
    optional("floor", config.floorTranslation, 0.);
    optional("floor_rotation", config.floorRotation, 0.);
    fly.finish();
    return config;
}

std::string toYaml(const FlyConfig& c) {
    std::string text = "fly:\n";
    const auto path = [&](const char* key, const std::string& file) {
        if (!file.empty()) text += fmt::format("  {}: {}\n", key, YAML::Dump(YAML::Node(file)));
    };
    const auto optional = [&](const char* key, const std::optional<double>& value) {
        if (value) text += fmt::format("  {}: {}\n", key, *value);
    };
    path("plan", c.plan);
    path("map", c.map);
    optional("scale", c.scale);
    optional("floor", c.floorTranslation);
    optional("floor_rotation", c.floorRotation);
    return text + fmt::format(
                      "  flights: {}\n  speed: {}\n  rate: {}\n  latency: {}\n  drop: {}\n"
                      "  black: {}\n  blackout: [{}, {}]\n  camera: {}\n  odometry: {}\n"
                      "  body_radius: {}\n  photometric_goal: {}\n",
                      c.flights, c.speed, c.rate, c.latency, c.drop, c.black, c.blackout[0],
                      c.blackout[1], c.camera, c.odometry, c.bodyRadius, c.photometricGoal);
}

}  // namespace photonav
