// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "command_line.hpp"
#include "fly_command.hpp"
#include "fly_config.hpp"
#include "replay_calibration.hpp"

namespace photonav {
namespace {

/// Every key of the config's `fly` that has an option: --body-radius is fly.body_radius.
constexpr std::array kKeys{
    "flights", "speed",    "rate",        "latency",          "drop",  "black", "blackout",
    "camera",  "odometry", "body_radius", "photometric_goal", "scale", "floor", "floor_rotation"};

std::string optionOf(std::string key) {
    std::replace(key.begin(), key.end(), '_', '-');
    return "--" + key;
}

std::string complaintAboutBlackout(const std::string& text) {
    double start = -1.;
    double length = -1.;
    char rest = 0;
    const int read = std::sscanf(text.c_str(), "%lf,%lf%c", &start, &length, &rest);
    return read == 2 && start >= 0. && length >= 0. ? "" : "expected start,length in seconds";
}

double numberIn(const std::string& text) {
    double value = 0.;
    char rest = 0;
    const bool isNumber = std::sscanf(text.c_str(), "%lf%c", &value, &rest) == 1;
    return isNumber && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

std::string complaintUnlessPositive(const std::string& text) {
    return numberIn(text) > 0. ? "" : "must be a number above 0";
}

std::string complaintUnlessNotNegative(const std::string& text) {
    return numberIn(text) >= 0. ? "" : "must be a number, not negative";
}

void addFlight(CLI::App& parser, FlyConfig& typed) {
    const auto number = [&](const char* name, double& value, const char* what, double least,
                            double most) {
        parser.add_option(name, value, what)->check(CLI::Range(least, most))->capture_default_str();
    };
    parser.add_option("--flights", typed.flights, "per planner")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    number("--speed", typed.speed, "at most [m/s]", 0.01, 100.);
    number("--rate", typed.rate,
           "of the camera [Hz], at most one image a step of 20 ms (0: a view every planner.ds)", 0.,
           50.);
    number("--latency", typed.latency, "of images [s]", 0., 10.);
    number("--drop", typed.drop, "share of the images that never arrive", 0., 1.);
    number("--black", typed.black, "share of the images that are black", 0., 1.);
    parser.add_option("--blackout", "a time of black images [s]")
        ->type_name("START,LENGTH")
        ->check(complaintAboutBlackout);
    parser
        .add_option("--camera", typed.camera,
                    "noise of the images: as the config assumes, or as real cameras have")
        ->check(CLI::IsMember({"assumed", "real"}))
        ->capture_default_str();
    number("--odometry", typed.odometry, "true variance of the odometry by the assumed one", 0.,
           1e6);
    number("--body-radius", typed.bodyRadius,
           "of collisions [m] (0: half of robot.radius, the rest is margin)", 0., 1e3);
    parser.add_flag("--photometric-goal,!--no-photometric-goal", typed.photometricGoal,
                    "servo on the goal's image at the end (the default)");
}

/// What the images are worth, and what they are compared with.
void addTracking(CLI::App& parser, FlyConfig& typed) {
    parser.add_option("--map", typed.map,
                      "track in this textured octree (.ot), mesh or scene file instead of the true "
                      "world");
    parser
        .add_option("--scale", typed.scale,
                    "factor on the information (default: camera.information_scale, a quarter of it "
                    "with --camera real)")
        ->check(complaintUnlessPositive);
    parser
        .add_option("--floor", typed.floorTranslation,
                    "least standard deviation of a position [m] (default: that of the map's cells)")
        ->check(complaintUnlessNotNegative);
    parser.add_option("--floor-rotation", typed.floorRotation, "the same of a rotation [rad]")
        ->check(complaintUnlessNotNegative);
    parser
        .add_option("--calibration",
                    "these three from the calibration.yaml of a replay --calibrate, the factor by "
                    "the number of images whose errors are alike (each gives way to its own "
                    "option)")
        ->type_name("FILE");
}

/// What was typed goes over the config, as --set would.
void override(const CLI::App& parser, std::vector<std::string>& overrides) {
    if (parser.count("--calibration") > 0) {
        const Calibration c = readCalibration(parser["--calibration"]->as<std::string>(), false);
        overrides.push_back(fmt::format("fly.scale={}", c.scale / c.correlationTime));
        overrides.push_back(fmt::format("fly.floor={}", c.floorTranslation));
        overrides.push_back(fmt::format("fly.floor_rotation={}", c.floorRotation));
    }
    if (parser.count("--map") > 0) {
        const auto file = std::filesystem::absolute(parser["--map"]->as<std::string>());
        overrides.push_back("fly.map=" + file.lexically_normal().string());
    }
    for (const std::string key : kKeys) {
        const CLI::Option* option = parser.get_option(optionOf(key));
        if (option->count() == 0) continue;
        const std::string value = option->results().back();
        overrides.push_back(
            fmt::format("fly.{}={}", key, key == "blackout" ? "[" + value + "]" : value));
    }
}

}  // namespace

Command flyCommand(CLI::App& app, const Invocation& invocation) {
    struct Options : FlyOptions {
        std::string seed;
        FlyConfig typed;
    };
    auto options = std::make_shared<Options>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser =
        app.add_subcommand("fly",
                           "Fly a plan in closed loop, many times, beside RRT*'s. Exit code 0: a "
                           "flight of the config's planner arrived.");
    addCommon(*parser, *options);
    parser->get_option("config")->description("YAML file, or result folder of photonav plan");
    parser->add_option("--jobs", options->jobs, "threads")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    addSeed(*parser, options->seed, "of everything random");
    addFlight(*parser, options->typed);
    addTracking(*parser, options->typed);
    parser
        ->add_option("--record", options->record, "write the first flight as a TUM RGB-D recording")
        ->type_name("DIR");
    return {parser, [options, parser, &interrupted = invocation.interrupted] {
                if (!options->seed.empty()) options->overrides.push_back("seed=" + options->seed);
                override(*parser, options->overrides);
                return runFly(*options, interrupted);
            }};
}

}  // namespace photonav
