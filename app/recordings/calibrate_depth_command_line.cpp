// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "commands/calibrate_depth_command.hpp"
#include "commands/command_line.hpp"

namespace photonav {
namespace {

struct CalibrateDepthArguments : CalibrateDepthOptions {
    bool quiet = false;
    bool json = false;
};

int run(CalibrateDepthArguments& options, const std::atomic<bool>& interrupted) {
    if (options.out.empty()) options.out = "out/calibrate-depth-" + folderName(options.dataset);
    ProgressLine line(options.quiet);
    options.progress = [&line](std::size_t done, std::size_t total) {
        line.show(fmt::format("{} of {} images", done, total));
    };
    const CalibrateDepthReport report = runCalibrateDepth(options, interrupted);
    line.clear();
    if (report.exitCode == kDone) {
        printOutput({options.out, options.quiet, options.json}, report.result, report.summary,
                    {"camera.yaml"});
    }
    return report.exitCode;
}

}  // namespace

Command calibrateDepthCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<CalibrateDepthArguments>();
    CLI::App* parser = app.add_subcommand(
        "calibrate-depth",
        "Find where the depth camera of a recording sits beside its colour camera.");
    parser->add_option("dataset", options->dataset, "folder in the TUM RGB-D layout")->required();
    parser->add_option("--camera", options->cameraFile,
                       "instead of the dataset's camera.yaml; its depth_camera is where to start");
    parser->add_option("--frames", options->frames, "\"a:b\": frames from a on and before b");
    parser->add_option("--every", options->every, "use every n-th frame");
    addOutput(*parser, {options->out, options->quiet, options->json},
              "out/calibrate-depth-<dataset>");
    return {parser, [options, &interrupted = invocation.interrupted] {
                return run(*options, interrupted);
            }};
}

}  // namespace photonav
