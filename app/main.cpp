// SPDX-License-Identifier: BSD-3-Clause
// The command line: subcommands only.
#include <fmt/format.h>
#include <ompl/util/Console.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>

#include "command_io.hpp"
#include "error.hpp"
#include "info_command.hpp"
#include "plan_command.hpp"
#include "report.hpp"

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// The first Ctrl-C asks politely, the second one does not.
void onInterrupt(int) {
    if (interrupted.exchange(true)) std::_Exit(photonav::kInterrupted);
}

void addCommon(CLI::App* command, photonav::CommandOptions& options) {
    command->add_option("config", options.config, "YAML file of the planning problem")->required();
    command->add_option("--set", options.overrides, "override a value: key.path=value")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command->add_option("--out", options.out, "result folder (default: out/<command>-<config>)");
    command->add_flag("--quiet", options.quiet, "no progress, no summary");
    command->add_flag("--json", options.json, "result.json on standard output");
}

int rebuildReport(const std::string& folder) {
    const std::filesystem::path path(folder);
    photonav::writeReport(path / "report.html", photonav::readReportData(path / "report.json"));
    fmt::print("report: {}\n", (path / "report.html").string());
    return photonav::kDone;
}

int run(int argc, char** argv) {
    CLI::App app{
        "photonav: paths on which the camera always sees enough texture to know where it is.\n"
        "Start with: photonav plan config/two_textures.yaml"};
    app.set_version_flag("--version", PHOTONAV_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done; 1 ran, but found no answer; 2 bad input; 130 stopped by Ctrl-C.\n"
        "Every run writes result.json, config.yaml, figures and report.html into its folder.");
    std::string commandLine = "photonav";
    for (int i = 1; i < argc; ++i) commandLine += std::string(" ") + argv[i];

    photonav::PlanOptions plan;
    CLI::App* planCommand =
        app.add_subcommand("plan", "plan a perception-aware path in a known scene or map");
    addCommon(planCommand, plan);
    std::string seed;
    planCommand->add_option("--seed", seed, "seed of everything random (overrides the config)");
    planCommand->add_flag("--audit", plan.audit, "replay every stored belief from the start");

    photonav::InfoOptions info;
    CLI::App* infoCommand =
        app.add_subcommand("info", "where a view is worth something, and which of its pixels");
    addCommon(infoCommand, info);
    infoCommand->add_option("--height", info.height, "height of the heat map [m]");
    infoCommand->add_option("--at", info.at, "x,y,z[,yaw] of the single view");
    infoCommand->add_option("--cells", info.cells, "cells along the longer side")
        ->check(CLI::Range(1, 2000));

    std::string reportFolder;
    CLI::App* reportCommand =
        app.add_subcommand("report", "rebuild report.html of a result folder");
    reportCommand->add_option("folder", reportFolder, "result folder")->required();

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        fmt::print(stderr, "photonav: {} (see photonav --help)\n", error.what());
        return photonav::kBadInput;
    }

    if (planCommand->parsed()) {
        if (!seed.empty()) plan.overrides.push_back("seed=" + seed);
        plan.commandLine = commandLine;
        return photonav::runPlan(plan, interrupted);
    }
    if (infoCommand->parsed()) {
        info.commandLine = commandLine;
        return photonav::runInfo(info);
    }
    return rebuildReport(reportFolder);
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, onInterrupt);
    ompl::msg::noOutputHandler();
    try {
        return run(argc, argv);
    } catch (const photonav::InputError& error) {
        fmt::print(stderr, "photonav: {}\n", error.what());
        return photonav::kBadInput;
    } catch (const std::exception& error) {
        fmt::print(stderr, "photonav: {}\n", error.what());
        return photonav::kBadInput;
    }
}
