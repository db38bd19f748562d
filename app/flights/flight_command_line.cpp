// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/config_keys.hpp"
#include "flight/flight_setup.hpp"
#include "flights/fly_command.hpp"
#include "flights/posters_command.hpp"
#include "flights/servo_command.hpp"
#include "replay/calibration_file.hpp"
#include "shared/command_line.hpp"

namespace photonav {
namespace {

using FlyArguments = WithKeys<FlyOptions, FlyConfig>;

void addFlyOptions(CLI::App& parser, FlyArguments& options) {
    addCommon(parser, options);
    parser.get_option("config")->description(
        "YAML file of the planning problem, or result folder of photonav plan (or the result.json "
        "or path.tum in it)");
    addJobs(parser, options.jobs);
    addSeed(parser, options.overrides, "seed of all random numbers");
    addKeys(options.keys, options.typed);
    addKeyOverrides(parser, options.keys, {"plan"}, options.overrides);  // plan: the argument
    parser
        .add_option("--calibration", options.calibration,
                    "scale and least sigmas from the calibration.yaml of photonav replay "
                    "--calibrate; the scale is divided by the number of images with "
                    "correlated errors; --scale, --least-sigma and --least-sigma-rotation "
                    "override it")
        ->type_name("FILE");
    addRecord(parser, options.record);
}

/// Options of the command line and --set override the calibration.
int flyCalibrated(FlyArguments& options, const std::atomic<bool>& interrupted) {
    if (!options.calibration.empty()) {
        FlyConfig fly;
        applyCalibration(readCalibration(options.calibration), fly);
        const auto calibrated = {
            fmt::format("fly.scale={}", *fly.scale),
            fmt::format("fly.least_sigma={}", *fly.leastSigma),
            fmt::format("fly.least_sigma_rotation={}", *fly.leastSigmaRotation)};
        options.overrides.insert(options.overrides.begin(), calibrated);
    }
    return runFly(options, interrupted);
}

std::string listText(const std::vector<double>& numbers) {
    return fmt::format("(default: {})", fmt::join(numbers, ","));
}

/// All of ServoOptions but what every command has, and the seed.
void addStudyOptions(CLI::App& parser, ServoOptions& options) {
    ServoStudyOptions& study = options.study;
    parser.add_option("--at", options.at,
                      "x,y,z[,yaw] of the robot at the goal (default: the config's goal)");
    parser.add_option(
        "--distances", options.distances,
        "distances of the starts from the goal: a,b,c [m] " + listText(study.distances));
    parser.add_option("--angles", options.angles,
                      "rotations of the starts: a,b,c [degrees] " + listText(study.angles));
    addNumber(parser, "--trials", study.trials, "number of starts for each distance and angle", 1,
              100000);
    parser.add_flag("--tilt", study.hasTilt,
                    "control six degrees of freedom; without it x, y, z and yaw, as the robot");
    addNumber(parser, "--gain", study.gain, "gain: rate of the error's exponential decrease [1/s]",
              1e-3, 1e3);
    addNumber(parser, "--damping", study.damping, "mu of Levenberg-Marquardt; 0: Gauss-Newton", 0.,
              1e6);
    addNumber(parser, "--rate", study.rate, "images per second", 0.1, 1e4);
    addNumber(parser, "--duration", study.duration, "time limit of a start [s]", 0.1, 1e5);
}

void addServoOptions(CLI::App& parser, ServoOptions& options) {
    addCommon(parser, options);
    addSeed(parser, options.overrides, "seed of the starts and of the image noise");
    addStudyOptions(parser, options);
}

void addPostersOptions(CLI::App& parser, PostersOptions& options) {
    addCommon(parser, options);
    parser
        .add_option("--candidates", options.candidates,
                    "YAML file of the candidates: a name and the keys of a scene file for each")
        ->type_name("FILE")
        ->required();
    parser
        .add_option("--trajectory", options.trajectory,
                    "file of a trajectory, as photonav check reads it (default: a path is planned "
                    "with every candidate)")
        ->type_name("FILE");
    CLI::Option* rankBy =
        parser
            .add_option("--rank-by", options.rankBy,
                        "path: by the uncertainty along it; goal: by servoing there")
            ->check(CLI::IsMember({"path", "goal"}))
            ->capture_default_str();
    parser
        .add_flag("--goal-only", options.goalOnly,
                  "do not plan paths, rank by servoing at the goal")
        ->excludes(rankBy);
    addNumber(parser, "--most", options.most,
              "number of candidates together; beyond one they are added to the best so far, one "
              "by one",
              std::size_t{1}, std::size_t{100});
    addJobs(parser, options.jobs);
    addSeed(parser, options.overrides, "seed of the planner, the starts and the image noise");
    options.study.distances = {0.2};
    options.study.angles = {10.};
    addStudyOptions(parser, options);
}

}  // namespace

Commands flightCommands(CLI::App& app, const Invocation& invocation) {
    return {makeCommand<FlyArguments>(
                app, invocation, "fly",
                "Fly a plan, and the plan of RRT*, in closed loop, many times. Exit code 0: a "
                "flight of the config's planner arrived.",
                addFlyOptions, flyCalibrated),
            makeCommand<ServoOptions>(
                app, invocation, "servo",
                "Study photometric servoing at a goal: from where and how fast it converges.",
                addServoOptions, runServo),
            makeCommand<PostersOptions>(
                app, invocation, "posters",
                "Rank posters and carpets by how certain they make a path, or servoing at a goal.",
                addPostersOptions, runPosters)};
}

}  // namespace photonav
