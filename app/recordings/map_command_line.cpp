// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "commands/command_line.hpp"
#include "commands/map_command.hpp"
#include "commands/scan_command.hpp"
#include "io/error.hpp"
#include "mapping/map_config.hpp"
#include "mapping/scan_map.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

struct MapArguments : MapCommandOptions {
    ScanCommandOptions scan;  ///< the same of point clouds
    bool quiet = false;
    bool json = false;
    KeyTable keys = keysOf(static_cast<MapOptions&>(*this));
    KeyTable scanKeys = keysOf(scan);
};

void addOptions(CLI::App& parser, MapArguments& options) {
    parser
        .add_option("dataset", options.dataset,
                    "folder in the TUM RGB-D, the EuRoC or the COLMAP layout, or a ROS 1 bag; or a "
                    "coloured point cloud (.ply), or a folder with one per station of the scanner; "
                    "or the config.yaml "
                    "of an earlier map")
        ->required();
    addKeyOptions(parser, options.keys, {"dataset"});
    addKeyOptions(parser, options.scanKeys, {"scans", "resolution", "max_range"});
    parser.get_option("--max-range")
        ->description(options.keys.find("max_range")->description() + " (point clouds: 40)");
    parser.get_option("--scanner")
        ->description("x,y,z of the scanner, for a point cloud without it");
    addOutput(parser, {options.out, options.quiet, options.json}, "out/map-<dataset>");
}

/// Completes the options for a laser scan; those that belong to images are errors.
void readScanOptions(const CLI::App& parser, MapArguments& options) {
    for (const ConfigKey& key : options.keys.keys()) {
        const std::string name = key.words.name;
        if (name == "dataset" || name == "resolution" || name == "max_range") continue;
        if (parser.count(optionOf(key)) == 0) continue;
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
    if (parser.count("--max-range") > 0) scan.maxRange = options.fusion.maxRange;
}

MapReport mapScans(const CLI::App& parser, MapArguments& options, ProgressLine& line,
                   const std::atomic<bool>& interrupted) {
    readScanOptions(parser, options);
    ScanCommandOptions& scan = options.scan;
    if (options.out.empty()) options.out = "out/map-" + folderName(scan.scans);
    scan.out = options.out;
    scan.progress = [&line](std::size_t done, std::size_t total) {
        line.show(fmt::format("{} of {} fused", done, total));
    };
    return runScanMap(scan, interrupted);
}

MapReport mapImages(const CLI::App& parser, bool isConfig, MapArguments& options,
                    ProgressLine& line, const std::atomic<bool>& interrupted) {
    if (parser.count("--scanner") > 0) {
        throw InputError("--scanner", "", "is for point clouds, not images");
    }
    if (isConfig) {
        options.keys.read(std::string(options.dataset));
    } else if (parser.count("--min-range") == 0) {
        options.fusion.minRange = defaultMinRange(options.depth);
    }
    if (options.out.empty()) options.out = "out/map-" + folderName(options.dataset);
    options.progress = [&line](std::size_t done, std::size_t total) {
        line.show(fmt::format("{} of {} fused", done, total));
    };
    return runMap(options, interrupted);
}

int run(const CLI::App& parser, MapArguments& options, const std::atomic<bool>& interrupted) {
    const bool isConfig = fs::path(options.dataset).extension() == ".yaml";
    if (isConfig) refuseOptionsBeside(options.dataset, parser);
    const bool isOfScans = isConfig ? isScanConfig(options.dataset) : isScan(options.dataset);
    ProgressLine line(options.quiet);
    const MapReport report = isOfScans ? mapScans(parser, options, line, interrupted)
                                       : mapImages(parser, isConfig, options, line, interrupted);
    line.clear();
    printOutput({options.out, options.quiet, options.json}, report.result, report.summary,
                report.exitCode == kNoAnswer ? std::vector<std::string>{"report.html"}
                                             : std::vector<std::string>{"map.ot", "report.html"});
    return report.exitCode;
}

}  // namespace

Command mapCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<MapArguments>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser = app.add_subcommand(
        "map",
        "Turn a recorded RGB-D or stereo recording, or laser scans into a textured OctoMap.");
    addOptions(*parser, *options);
    return {parser, [options, parser, &interrupted = invocation.interrupted] {
                return run(*parser, *options, interrupted);
            }};
}

}  // namespace photonav
