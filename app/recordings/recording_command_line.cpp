// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "io/error.hpp"
#include "mapping/map_config.hpp"
#include "mapping/scan_map.hpp"
#include "recordings/calibrate_depth_command.hpp"
#include "recordings/map_command.hpp"
#include "recordings/replay_command.hpp"
#include "recordings/scan_command.hpp"
#include "shared/command_line.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLayouts =
    "folder in the TUM RGB-D, the EuRoC or the COLMAP layout, or a ROS 1 bag; ";

/// The options of a command as they are typed.
template <typename Options>
struct Typed : Options {
    bool quiet = false;
    bool json = false;
    const CLI::App* parser = nullptr;
};

struct MapArguments : Typed<MapCommandOptions> {
    ScanCommandOptions scan;  ///< in place of these for point clouds
    KeyTable keys = keysOf(static_cast<MapOptions&>(*this));
    KeyTable scanKeys = keysOf(scan);
};

struct ReplayArguments : Typed<ReplayCommandOptions> {
    KeyTable keys = keysOf(static_cast<ReplayCommandOptions&>(*this));
};

using CalibrateDepthArguments = Typed<CalibrateDepthOptions>;

bool isConfig(const std::string& dataset) { return fs::path(dataset).extension() == ".yaml"; }

/// Runs a command on a dataset, with its progress on a line, and prints its results.
/// @param steps what it does one after the other: "images"
/// @param filesOf the files of the result folder to print
template <typename Options, typename Run, typename FilesOf>
int runOnDataset(Options& options, const std::string& command, const std::string& dataset,
                 const char* steps, const Run& run, const FilesOf& filesOf) {
    if (options.out.empty()) {
        options.out = fs::path("out") / (command + "-" + folderName(dataset));
    }
    ProgressLine line(options.quiet);
    const auto showing = [&line](const char* doing) {
        return [&line, doing](std::size_t done, std::size_t total) {
            if (done == 0) line.beginPhase();
            line.show(fmt::format("{} of {} {}", done, total, doing),
                      static_cast<double>(done) / static_cast<double>(total));
        };
    };
    options.progress = showing(steps);
    if constexpr (requires { options.comparison; }) options.comparison = showing("compared");
    const auto report = run();
    line.clear();
    if (report.folder.empty()) return report.exitCode;
    printOutput(options, report.folder, report.result, report.summary, filesOf(report.exitCode));
    return report.exitCode;
}

void addMapOptions(CLI::App& parser, MapArguments& options) {
    options.parser = &parser;
    parser
        .add_option("dataset", options.dataset,
                    std::string(kLayouts) +
                        "or a coloured point cloud (.ply), or a folder with one per station of the "
                        "scanner; or the config.yaml of an earlier map")
        ->required();
    addKeyOptions(parser, options.keys, {"dataset"});
    addKeyOptions(parser, options.scanKeys, {"scans", "resolution", "max_range"});
    parser.get_option("--max-range")
        ->description(options.keys.find("max_range")->description() + " (point clouds: 40)");
    parser.get_option("--scanner")
        ->description("x,y,z of the scanner, for a point cloud without it");
    addOutput(parser, options, "out/map-<dataset>");
}

/// Completes the options for a laser scan; those that belong to images are errors.
void readScanOptions(MapArguments& options) {
    for (const ConfigKey& key : options.keys.keys()) {
        const std::string name = key.words.name;
        if (name == "dataset" || name == "resolution" || name == "max_range") continue;
        if (options.parser->count(optionOf(key)) == 0) continue;
        throw InputError(optionOf(key), "", "is for images, not point clouds");
    }
    ScanCommandOptions& scan = options.scan;
    scan.commandLine = options.commandLine;
    if (!isScan(options.dataset)) {  // the config of an earlier map
        options.scanKeys.read(options.dataset);
        return;
    }
    scan.scans = options.dataset;
    scan.resolution = options.resolution;
    if (options.parser->count("--max-range") > 0) scan.maxRange = options.fusion.maxRange;
}

void readImageOptions(MapArguments& options) {
    if (options.parser->count("--scanner") > 0) {
        throw InputError("--scanner", "", "is for point clouds, not images");
    }
    if (isConfig(options.dataset)) {
        options.keys.read(std::string(options.dataset));
    } else if (options.parser->count("--min-range") == 0) {
        options.fusion.minRange = defaultMinRange(options.depth);
    }
}

int map(MapArguments& options, const std::atomic<bool>& interrupted) {
    const bool isAgain = isConfig(options.dataset);
    if (isAgain) refuseOptionsBeside(options.dataset, *options.parser);
    const bool isOfScans = isAgain ? isScanConfig(options.dataset) : isScan(options.dataset);
    isOfScans ? readScanOptions(options) : readImageOptions(options);
    options.isStopped = [&] { return interrupted.load(); };
    const auto run = [&] {
        if (!isOfScans) return runMap(options, interrupted);
        options.scan.out = options.out;
        options.scan.progress = options.progress;
        return runScanMap(options.scan, interrupted);
    };
    return runOnDataset(options, "map", isOfScans ? options.scan.scans : options.dataset, "fused",
                        run, [](int exitCode) -> std::vector<std::string> {
                            if (exitCode == kNoAnswer) return {"report.html"};
                            return {"map.ot", "report.html"};
                        });
}

void addCalibration(CLI::App& parser, std::string& file) {
    parser
        .add_option("--calibration", file,
                    "scale and least sigmas from the calibration.yaml of an earlier replay "
                    "--calibrate; --scale, --least-sigma and --least-sigma-rotation override it")
        ->type_name("FILE");
}

void addReplayOptions(CLI::App& parser, ReplayArguments& options) {
    options.parser = &parser;
    parser
        .add_option("dataset", options.dataset,
                    std::string(kLayouts) + "or the config.yaml of an earlier replay")
        ->required();
    addKeyOptions(parser, options.keys, {"dataset"});
    addCalibration(parser, options.calibration);
    addOutput(parser, options, "out/replay-<dataset>");
}

int replay(ReplayArguments& options, const std::atomic<bool>& interrupted) {
    if (isConfig(options.dataset)) {
        refuseOptionsBeside(options.dataset, *options.parser);
        options.keys.read(std::string(options.dataset));
    }
    options.isStopped = [&] { return interrupted.load(); };
    return runOnDataset(
        options, "replay", options.dataset, "frames",
        [&] { return runReplay(options, interrupted); },
        [](int) -> std::vector<std::string> { return {"report.html"}; });
}

void addCalibrateDepthOptions(CLI::App& parser, CalibrateDepthArguments& options) {
    parser.add_option("dataset", options.dataset, "folder in the TUM RGB-D layout")->required();
    parser
        .add_option("--camera", options.cameraFile,
                    "camera file in place of the dataset's camera.yaml; its depth_camera is where "
                    "the calibration starts")
        ->type_name("FILE");
    parser.add_option("--frames", options.frames, "\"a:b\": frames from a on and before b");
    parser.add_option("--every", options.every, "use every n-th frame");
    addOutput(parser, options, "out/calibrate-depth-<dataset>");
}

int calibrateDepth(CalibrateDepthArguments& options, const std::atomic<bool>& interrupted) {
    return runOnDataset(
        options, "calibrate-depth", options.dataset, "images",
        [&] { return runCalibrateDepth(options, interrupted); },
        [](int) -> std::vector<std::string> { return {"camera.yaml"}; });
}

}  // namespace

Commands recordingCommands(CLI::App& app, const Invocation& invocation) {
    return {makeCommand<MapArguments>(
                app, invocation, "map",
                "Make a textured OctoMap of an RGB-D, stereo or monocular recording, or of laser "
                "scans.",
                addMapOptions, map),
            makeCommand<ReplayArguments>(
                app, invocation, "replay",
                "Track a recorded flight, in a map or by odometry, and evaluate the result.",
                addReplayOptions, replay),
            makeCommand<CalibrateDepthArguments>(
                app, invocation, "calibrate-depth",
                "Find the pose of a recording's depth camera relative to its colour camera.",
                addCalibrateDepthOptions, calibrateDepth)};
}

}  // namespace photonav
