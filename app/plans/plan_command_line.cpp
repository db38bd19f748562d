// SPDX-License-Identifier: BSD-3-Clause
#include "io/error.hpp"
#include "map/octree_file.hpp"
#include "plans/check_command.hpp"
#include "plans/info_command.hpp"
#include "plans/plan_command.hpp"
#include "recordings/map_info.hpp"
#include "shared/command_line.hpp"

namespace photonav {
namespace {

void addPlanOptions(CLI::App& parser, PlanOptions& options) {
    addCommon(parser, options);
    addSeed(parser, options.overrides, "seed of all random numbers");
    addValue(parser, options.overrides, "--alpha", "planner.alpha",
             "1: the shortest path, 0: the most certain one");
    addValue(parser, options.overrides, "--kappa", "planner.kappa",
             "metres of detour that 1 m of flight at tr(Sigma) = 1 m^2 is worth, or auto [1/m^2]");
    parser.add_flag(
        "--audit", options.audit,
        "propagate every stored belief again from the start and print the largest error");
    parser.add_flag("--evolution", options.evolution,
                    "show how the trees of RRT* and of the planner grow (figure and animation)");
}

void addInfoOptions(CLI::App& parser, InfoOptions& options) {
    addCommon(parser, options);
    parser.get_option("config")->description(
        "YAML file of the planning problem; or a map (.ot, .bt), to see what it holds");
    limit(parser.add_option("--height", options.height,
                            "height of the heat map [m] (default: the height of the start)"),
          -1e5, 1e5);
    parser.add_option("--at", options.at,
                      "x,y,z[,yaw] of the robot for the single view (default: the start)");
    limit(parser.add_option("--cells", options.cells,
                            "cells along the longer side of the heat map (default: 100)"),
          1, 2000);
}

void addCheckOptions(CLI::App& parser, CheckCommandOptions& options) {
    parser
        .add_option("trajectory", options.trajectory,
                    "TUM or KITTI file, or CSV with quaternions (camera to world); or table with "
                    "the columns t,x,y,z,yaw, x,y,z, or those named in its first line")
        ->required();
    CLI::Option* map = parser.add_option("--map", options.map, "textured OctoMap (.ot)");
    map->type_name("FILE");
    parser.add_option("--scene", options.scene, "scene (.yaml) or mesh")
        ->type_name("FILE")
        ->excludes(map);
    parser
        .add_option("--config", options.config,
                    "YAML file of a planning problem: its camera, noise, robot, bounds and, "
                    "unless given here, its map or scene")
        ->type_name("FILE");
    parser
        .add_option("--heading", options.heading,
                    "heading of a table without headings: forward (along the motion), or an "
                    "angle [rad]")
        ->capture_default_str();
    addNumber(parser, "--headings", options.check.headings,
              "number of headings to compare at every place; 0: none", 0, 720);
    limit(parser.add_option(
              "--max-sigma", options.check.maxSigma,
              "standard deviation of the position above which the camera counts as lost [m]"),
          1e-6, 1e5);
    addNumber(parser, "--flights", options.flights,
              "number of simulated flights along the trajectory", 0U, 1000000U);
    addJobs(parser, options.jobs);
    addSeed(parser, options.overrides, "seed of the flights");
    addOverrides(parser, options.overrides);
    addOutput(parser, options, "out/check-<trajectory>");
}

int describeMap(InfoOptions& options, const std::atomic<bool>& interrupted) {
    const auto refuse = [](const char* option, bool isTyped) {
        if (isTyped) throw InputError(option, "", "is for a planning problem, not for a map");
    };
    refuse("--height", options.height.has_value());
    refuse("--at", options.at.has_value());
    refuse("--cells", options.cells.has_value());
    if (options.out.empty()) {
        options.out = "out/info-" + std::filesystem::path(options.config).stem().string();
    }
    const CommandReport report = runMapInfo(options, interrupted);
    printOutput(options, report.folder, report.result, report.summary, {"report.html"});
    return kDone;
}

int info(InfoOptions& options, const std::atomic<bool>& interrupted) {
    return isOcTreeFile(options.config) ? describeMap(options, interrupted)
                                        : runInfo(options, interrupted);
}

}  // namespace

Commands planCommands(CLI::App& app, const Invocation& invocation) {
    return {makeCommand<PlanOptions>(app, invocation, "plan",
                                     "Plan a perception-aware path in a known scene or map.",
                                     addPlanOptions, runPlan),
            makeCommand<InfoOptions>(app, invocation, "info",
                                     "Show how much information views give, and what a map holds.",
                                     addInfoOptions, info),
            makeCommand<CheckCommandOptions>(
                app, invocation, "check",
                "Check whether the camera stays localised along a trajectory of another program.",
                addCheckOptions, runCheck)};
}

}  // namespace photonav
