// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "commands/command_line.hpp"
#include "commands/fly_command.hpp"
#include "config/config_keys.hpp"
#include "flight/flight_setup.hpp"
#include "replay/calibration_file.hpp"

namespace photonav {
namespace {

struct FlyArguments : FlyOptions {
    std::string seed;
    FlyConfig typed;  ///< the defaults
    KeyTable keys;    ///< of `typed`
};

/// What was typed goes over the config, as --set would.
void override(const CLI::App& parser, const KeyTable& keys, FlyOptions& options) {
    std::vector<std::string>& overrides = options.overrides;
    if (!options.calibration.empty()) {
        FlyConfig fly;
        applyCalibration(readCalibration(options.calibration), fly);
        overrides.push_back(fmt::format("fly.scale={}", *fly.scale));
        overrides.push_back(fmt::format("fly.least_sigma={}", *fly.leastSigma));
        overrides.push_back(fmt::format("fly.least_sigma_rotation={}", *fly.leastSigmaRotation));
    }
    for (const ConfigKey& key : keys.keys()) {
        const CLI::Option* option = parser.get_option_no_throw(optionOf(key));
        if (option == nullptr || option->count() == 0) continue;
        std::string value = valueOf(key, option->results().back());
        if (key.isFile) value = std::filesystem::absolute(value).lexically_normal().string();
        overrides.push_back(fmt::format("{}={}", key.path(), value));
    }
}

}  // namespace

Command flyCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<FlyArguments>();
    addKeys(options->keys, options->typed);
    options->commandLine = invocation.commandLine;
    CLI::App* parser =
        app.add_subcommand("fly",
                           "Fly a plan and RRT*'s plan in closed loop, many times. Exit code 0: a "
                           "flight of the config's planner arrived.");
    addCommon(*parser, *options);
    parser->get_option("config")->description("YAML file, or result folder of photonav plan");
    parser->add_option("--jobs", options->jobs, "threads")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    addSeed(*parser, options->seed, "seed of all random numbers");
    addKeyOptions(*parser, options->keys, {"plan"});  // the positional argument
    parser
        ->add_option("--calibration", options->calibration,
                     "scale and least sigmas from the calibration.yaml of a replay "
                     "--calibrate; the scale is divided by the number of images with "
                     "correlated errors; --scale, --least-sigma and --least-sigma-rotation "
                     "override it")
        ->type_name("FILE");
    parser
        ->add_option("--record", options->record, "write the first flight as a TUM RGB-D recording")
        ->type_name("DIR");
    return {parser, [options, parser, &interrupted = invocation.interrupted] {
                if (!options->seed.empty()) options->overrides.push_back("seed=" + options->seed);
                override(*parser, options->keys, *options);
                return runFly(*options, interrupted);
            }};
}

}  // namespace photonav
