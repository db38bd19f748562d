// SPDX-License-Identifier: BSD-3-Clause
#include "commands/scan_command.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <set>

#include "commands/command_io.hpp"
#include "commands/map_config.hpp"
#include "commands/result_folder.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "map/octree_file.hpp"
#include "map/point_cloud.hpp"
#include "report/map_report.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A scanner's echo is a surface, and a ray that grazes its cell on the way elsewhere is weak
// evidence of free space.
constexpr double kHit = 0.9, kMiss = 0.4;

std::set<fs::path> plyFiles(const fs::path& path) {
    if (!fs::is_directory(path)) return {path};
    std::set<fs::path> files;
    for (const auto& entry : fs::directory_iterator(path)) {
        if (entry.path().extension() == ".ply") files.insert(entry.path());
    }
    return files;
}

void checkOptions(const ScanMapOptions& options, std::size_t files) {
    const auto positive = [](double value, const char* option) {
        if (std::isfinite(value) && value > 0.) return;
        throw InputError(option, "", fmt::format("{} is not a positive number", value));
    };
    positive(options.resolution, "--resolution");
    positive(options.maxRange, "--max-range");
    if (options.scanner && files > 1) {
        throw InputError("--scanner", "",
                         fmt::format("one place for {} files; map them one by one, or let the "
                                     "files have it (element camera, as PCL writes it)",
                                     files));
    }
}

/// Fuses one file, streaming. @returns its entry of result.json
json fuseStation(const PointCloudFile& cloud, const fs::path& file, const ScanMapOptions& options,
                 TexturedOcTree& map) {
    const auto scanner = options.scanner ? options.scanner : cloud.scanner();
    std::uint64_t visits = 0;
    const Stopwatch watch;
    const auto points = [&](const std::function<void(const ScanPoint&)>& visit) {
        visits = 0;
        cloud.read([&](const ScanPoint& point) {
            ++visits;
            visit(point);
        });
        if (visits == 0) throw InputError(file.string(), "", "no point is finite");
    };
    try {
        fuseScan(map, points, scanner, options.maxRange);
    } catch (const std::invalid_argument&) {
        throw InputError(file.string(), "",
                         fmt::format("the points reach too far for cells of {} m: take a "
                                     "larger --resolution or a smaller --max-range",
                                     options.resolution));
    }
    json station{{"file", file.filename().string()},
                 {"points", cloud.size()},
                 {"used", visits},
                 {"seconds", watch.seconds()},
                 {"scanner", nullptr}};
    if (scanner) station["scanner"] = {scanner->x(), scanner->y(), scanner->z()};
    return station;
}

/// Fuses all files until interrupted. @returns their entries of result.json
json fuseStations(const std::vector<std::pair<fs::path, PointCloudFile>>& clouds,
                  const ScanMapOptions& options, const std::atomic<bool>& interrupted,
                  TexturedOcTree& map) {
    json stations = json::array();
    for (const auto& [file, cloud] : clouds) {
        if (interrupted) break;
        stations.push_back(fuseStation(cloud, file, options, map));
        if (options.progress) options.progress(stations.size(), clouds.size());
    }
    return stations;
}

ReportTable summaryOf(const json& result) {
    std::uint64_t points = 0;
    for (const json& station : result["stations"]) points += station["used"].get<std::uint64_t>();
    return {"Map",
            {{"stations", std::to_string(result["stations"].size())},
             {"points", std::to_string(points)},
             {"cell", fmt::format("{} m", result["resolution"].get<double>())},
             {"occupied cells", result["voxels"]["occupied"].dump()},
             {"free cells", result["voxels"]["free"].dump()},
             {"fusion", fmt::format("{:.1f} s", result["time"]["fuse_s"].get<double>())}}};
}

void writeScanReport(const ScanMapOptions& options, const json& result, const ReportTable& summary,
                     const TexturedOcTree& map) {
    ReportData report;
    report.title = "Map of " + fs::path(options.scans).lexically_normal().filename().string();
    report.subtitle = "A textured OctoMap from laser scans.";
    report.commandLine = options.commandLine;
    report.version = PHOTONAV_VERSION;
    report.result = result;
    report.config = toYaml(options);
    report.voxels = makeReportVoxels(map);
    report.tables = {summary};
    std::vector<NamedFigure> figures;
    if (!result["stations"].empty()) figures.push_back(overview(map, report.title));
    writeResultFolder(options.out, report, figures);
}

/// Of this process, so far.
long peakMegabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

}  // namespace

bool isScan(const std::string& path) {
    if (fs::is_directory(path))
        return !fs::exists(fs::path(path) / "rgb.txt") && !plyFiles(path).empty();
    return fs::path(path).extension() == ".ply";
}

MapReport runScanMap(const ScanMapOptions& options, const std::atomic<bool>& interrupted) {
    const std::set<fs::path> files = plyFiles(options.scans);
    checkOptions(options, files.size());
    std::vector<std::pair<fs::path, PointCloudFile>> clouds;  // all headers, before any work
    clouds.reserve(files.size());
    for (const fs::path& file : files) clouds.emplace_back(file, file.string());
    const NoEmptyFolder noEmptyFolder(options.out);  // a refused scan leaves nothing
    claimFolder(options.out, {options.scans});

    const Stopwatch watch;
    TexturedOcTree map(options.resolution);
    map.setProbHit(kHit);
    map.setProbMiss(kMiss);
    const json stations = fuseStations(clouds, options, interrupted, map);
    MapReport report;
    report.exitCode = interrupted ? kInterrupted : kDone;
    report.result = {{"schema", 1},
                     {"command", "map"},
                     {"version", PHOTONAV_VERSION},
                     {"interrupted", report.exitCode == kInterrupted},
                     {"scans", options.scans},
                     {"stations", stations},
                     {"resolution", options.resolution},
                     {"max_range", options.maxRange},
                     {"voxels", voxelsJson(map)},
                     {"time", {{"fuse_s", watch.seconds()}}}};
    report.summary = summaryOf(report.result);
    saveTexturedOcTree(map, (options.out / "map.ot").string());
    saveColorOcTree(map, (options.out / "map_color.ot").string());
    saveBinaryOcTree(map, (options.out / "map.bt").string());
    writeScanReport(options, report.result, report.summary, map);
    const long peak = peakMegabytes();  // all work is done, the report is written
    report.result["peak_memory_mb"] = peak;
    report.summary.rows.emplace_back("peak memory", fmt::format("{} MB", peak));
    writeFileAtomically(options.out / "result.json", report.result.dump(2) + "\n");
    return report;
}

}  // namespace photonav
