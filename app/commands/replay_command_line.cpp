// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "commands/command_line.hpp"
#include "commands/replay_command.hpp"
#include "replay/replay_calibration.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

struct ReplayArguments : ReplayCommandOptions {
    bool quiet = false;
    bool json = false;
    std::string calibration;  ///< file that says what scale and floors were not typed
};

void addTracking(CLI::App& parser, ReplayArguments& options) {
    parser.add_option("--sigma", options.sigma, "image noise, grey values in [0, 1]")
        ->capture_default_str();
    parser.add_option(
        "--scale", options.scale,
        "factor on the information (default: information_scale of camera.yaml in a map, "
        "else the tracker's)");
    parser
        .add_option("--sigma-floor", options.floorTranslation,
                    "least standard deviation of a position in a map [m] (default: the tracker's)")
        ->capture_default_str();
    parser
        .add_option("--sigma-floor-rotation", options.floorRotation, "the same of a rotation [rad]")
        ->capture_default_str();
    parser
        .add_option("--calibration", options.calibration,
                    "these three from the calibration.yaml of a --calibrate (each gives way to its "
                    "own option)")
        ->type_name("FILE");
    parser.add_option("--max-width", options.maxWidth,
                      "images are halved until they are as wide [pixels] (default: 320 in a map, "
                      "once in odometry)");
    parser
        .add_option("--min-overlap", options.minOverlap,
                    "least share of an image that the model must cover")
        ->capture_default_str();
    parser.add_flag("!--no-exposure", options.exposure, "images do not change in brightness");
}

void addOptions(CLI::App& parser, ReplayArguments& options) {
    parser
        .add_option("dataset", options.dataset,
                    "folder in the TUM RGB-D or the EuRoC layout; or the config.yaml of an earlier "
                    "replay")
        ->required();
    parser.add_option("--map", options.mapFile,
                      "localise in this textured octree (.ot), mesh or scene file");
    parser.add_flag("--odometry", options.odometry, "from image to image instead, without a map");
    parser.add_option("--start", options.start, "x,y,z,qx,qy,qz,qw of the first frame's camera")
        ->type_name("POSE");
    parser.add_option(
        "--start-sigma", options.startSigma,
        fmt::format("its standard deviation in a map [m] and [rad] (default: {})", kStartSigma));
    addRecording(parser, options);
    addTracking(parser, options);
    parser.add_flag("--calibrate", options.calibrate,
                    "fit factor and floor that would have made the covariances true");
    addOutput(parser, {options.out, options.quiet, options.json}, "out/replay-<dataset>");
}

int run(const CLI::App& parser, ReplayArguments& options, const std::atomic<bool>& interrupted) {
    if (fs::path(options.dataset).extension() == ".yaml") {
        refuseOptionsBeside(options.dataset, parser);
        keysOf(options).read(std::string(options.dataset));
    }
    if (!options.calibration.empty()) {
        const Calibration calibration = readCalibration(options.calibration, options.odometry);
        const auto give = [](std::optional<double>& option, double value) {
            if (!option) option = value;
        };
        give(options.scale, calibration.scale);
        give(options.floorTranslation, calibration.floorTranslation);
        give(options.floorRotation, calibration.floorRotation);
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
    CLI::App* parser = app.add_subcommand(
        "replay", "Track a recorded flight, in a map or by odometry, and say how well.");
    addOptions(*parser, *options);
    return {parser, [options, parser, &interrupted = invocation.interrupted] {
                return run(*parser, *options, interrupted);
            }};
}

}  // namespace photonav
