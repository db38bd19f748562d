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
    std::vector<double> scanner;
    bool quiet = false;
    bool json = false;
};

void addOptions(CLI::App& parser, MapArguments& options) {
    parser
        .add_option("dataset", options.dataset,
                    "folder in the TUM RGB-D or the EuRoC layout; or a coloured point cloud "
                    "(.ply), or a folder with one per station of the scanner; or the config.yaml "
                    "of an earlier map")
        ->required();
    parser.add_option("--resolution", options.resolution, "edge of a cell [m]")
        ->capture_default_str();
    parser
        .add_option("--depth", options.depth,
                    "recorded (of two cameras: stereo), or monocular: from the images of one and "
                    "their poses alone")
        ->capture_default_str();
    parser.add_option("--min-range", options.fusion.minRange,
                      "nearest depth trusted [m] (0.2, monocular: 0.5)");
    parser
        .add_option("--max-range", options.fusion.maxRange,
                    "farthest surface entered [m] (point clouds: 40)")
        ->capture_default_str();
    parser
        .add_option("--scanner", options.scanner,
                    "x,y,z of the scanner, for a point cloud without it")
        ->delimiter(',')
        ->expected(3);
    addRecording(parser, options);
    addOutput(parser, {options.out, options.quiet, options.json}, "out/map-<dataset>");
}

/// The options for a laser scan; those that belong to images are errors.
ScanCommandOptions scanOptions(const CLI::App& parser, const MapArguments& options) {
    for (const char* name : {"--camera", "--up", "--every", "--frames", "--min-range",
                             "--depth-scale", "--tolerance", "--depth", "--stereo"}) {
        if (parser.count(name) > 0) throw InputError(name, "", "is for images, not point clouds");
    }
    ScanCommandOptions scan;
    scan.commandLine = options.commandLine;
    if (!isScan(options.dataset)) {  // the config of an earlier map
        readScanConfig(options.dataset, scan);
        return scan;
    }
    scan.scans = options.dataset;
    scan.resolution = options.resolution;
    if (parser.count("--max-range") > 0) scan.maxRange = options.fusion.maxRange;
    if (!options.scanner.empty()) scan.scanner.emplace(options.scanner.data());
    return scan;
}

MapReport mapScans(const CLI::App& parser, MapArguments& options, ProgressLine& line,
                   const std::atomic<bool>& interrupted) {
    ScanCommandOptions scan = scanOptions(parser, options);
    if (options.out.empty()) options.out = "out/map-" + folderName(scan.scans);
    scan.out = options.out;
    scan.progress = [&line](std::size_t done, std::size_t total) {
        line.show(fmt::format("{} of {} fused", done, total));
    };
    return runScanMap(scan, interrupted);
}

MapReport mapImages(const CLI::App& parser, bool isConfig, MapArguments& options,
                    ProgressLine& line, const std::atomic<bool>& interrupted) {
    if (!options.scanner.empty()) {
        throw InputError("--scanner", "", "is for point clouds, not images");
    }
    if (isConfig) {
        readMapConfig(std::string(options.dataset), options);
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
