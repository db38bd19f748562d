// SPDX-License-Identifier: BSD-3-Clause
#include "commands/check_command.hpp"
#include "commands/command_line.hpp"

namespace photonav {
namespace {

void addOptions(CLI::App& parser, CheckCommandOptions& options, std::string& seed) {
    parser
        .add_option("trajectory", options.trajectory,
                    "TUM file (camera to world), or table with the columns t,x,y,z,yaw, x,y,z, or "
                    "those named in its first line")
        ->required();
    CLI::Option* map = parser.add_option("--map", options.map, "textured OctoMap (.ot, .bt)");
    parser.add_option("--scene", options.scene, "scene (.yaml) or mesh")->excludes(map);
    parser.add_option("--config", options.config,
                      "YAML file of a planning problem: its camera, noise, robot, bounds and, "
                      "unless given here, its map or scene");
    parser
        .add_option("--heading", options.heading,
                    "heading of a table without headings: forward (along the motion), or an "
                    "angle [rad]")
        ->capture_default_str();
    parser
        .add_option("--headings", options.check.headings,
                    "headings compared at every place; 0: none")
        ->check(CLI::Range(0, 720))
        ->capture_default_str();
    parser
        .add_option("--max-sigma", options.check.maxSigma,
                    "standard deviation of the position above which the camera counts as lost [m]")
        ->check(CLI::Range(1e-6, 1e5));
    parser.add_option("--flights", options.flights, "flights along the trajectory in simulation")
        ->check(CLI::Range(0, 1000000))
        ->capture_default_str();
    parser.add_option("--jobs", options.jobs, "threads of the flights")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    addSeed(parser, seed, "seed of the flights");
    addOverrides(parser, options.overrides);
    addOutput(parser, {options.out, options.quiet, options.json}, "out/check-<trajectory>");
}

}  // namespace

Command checkCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<CheckCommandOptions>();
    auto seed = std::make_shared<std::string>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser = app.add_subcommand(
        "check", "Will the camera stay localised along a trajectory that another program made?");
    addOptions(*parser, *options, *seed);
    return {parser, [options, seed, &interrupted = invocation.interrupted] {
                if (!seed->empty()) options->overrides.push_back("seed=" + *seed);
                return runCheck(*options, interrupted);
            }};
}

}  // namespace photonav
