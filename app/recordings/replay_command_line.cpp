// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "commands/command_line.hpp"
#include "commands/replay_command.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

struct ReplayArguments : ReplayCommandOptions {
    bool quiet = false;
    bool json = false;
    KeyTable keys = keysOf(static_cast<ReplayCommandOptions&>(*this));
};

void addOptions(CLI::App& parser, ReplayArguments& options) {
    parser
        .add_option("dataset", options.dataset,
                    "folder in the TUM RGB-D, the EuRoC or the COLMAP layout, or a ROS 1 bag; "
                    "or the config.yaml of an earlier replay")
        ->required();
    addKeyOptions(parser, options.keys, {"dataset"});
    parser
        .add_option("--calibration", options.calibration,
                    "scale and least sigmas from the calibration.yaml of an earlier replay "
                    "--calibrate; --scale, --least-sigma and --least-sigma-rotation "
                    "override it")
        ->type_name("FILE");
    addOutput(parser, {options.out, options.quiet, options.json}, "out/replay-<dataset>");
}

int run(const CLI::App& parser, ReplayArguments& options, const std::atomic<bool>& interrupted) {
    if (fs::path(options.dataset).extension() == ".yaml") {
        refuseOptionsBeside(options.dataset, parser);
        options.keys.read(std::string(options.dataset));
    }
    if (options.out.empty()) options.out = "out/replay-" + folderName(options.dataset);
    ProgressLine line(options.quiet);
    options.progress = [&line](std::size_t done, std::size_t total) {
        line.show(fmt::format("{} of {} frames", done, total));
    };
    const ReplayReport report = runReplay(options, interrupted);
    line.clear();
    printOutput({options.out, options.quiet, options.json}, report.result, report.summary,
                {"report.html"});
    return report.exitCode;
}

}  // namespace

Command replayCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<ReplayArguments>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser =
        app.add_subcommand("replay",
                           "Track a recorded flight, in a map or by odometry, and evaluate the "
                           "result.");
    addOptions(*parser, *options);
    return {parser, [options, parser, &interrupted = invocation.interrupted] {
                return run(*parser, *options, interrupted);
            }};
}

}  // namespace photonav
