// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/scan_command.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include "io/stopwatch.hpp"
#include "map/octree_file.hpp"
#include "mapping/map_config.hpp"
#include "mapping/scan_map.hpp"
#include "recordings/map_report.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json stationsJson(const std::vector<FusedScan>& scans) {
    json stations = json::array();
    for (const FusedScan& scan : scans) {
        stations.push_back({{"file", scan.file.filename().string()},
                            {"points", scan.points},
                            {"used", scan.used},
                            {"seconds", scan.seconds},
                            {"scanner", nullptr}});
        if (const auto& p = scan.scanner) stations.back()["scanner"] = {p->x(), p->y(), p->z()};
    }
    return stations;
}

ReportTable summaryOf(const json& result) {
    std::uint64_t points = 0;
    for (const json& station : result["stations"]) points += station["used"].get<std::uint64_t>();
    ReportTable table{
        "Map",
        {{"stations", std::to_string(result["stations"].size())},
         {"points", std::to_string(points)},
         {"cell", fmt::format("{} m", result["resolution"].get<double>())},
         {"occupied cells", result["voxels"]["occupied"].dump()},
         {"free cells", result["voxels"]["free"].dump()},
         {"fusion", fmt::format("{:.1f} s", result["time"]["fuse_s"].get<double>())}}};
    if (result["voxels"]["occupied"] == 0 && !result["interrupted"]) {
        table.rows.emplace(table.rows.begin(), "verdict",
                           fmt::format("the map is empty: no surface within --max-range {} m",
                                       result["max_range"].get<double>()));
    }
    return table;
}

void writeScanReport(const fs::path& folder, const ScanCommandOptions& options, const json& result,
                     const ReportTable& summary, const TexturedOcTree& map) {
    ReportData report;
    report.title = "Map of " + fs::path(options.scans).lexically_normal().filename().string();
    report.subtitle = "A textured OctoMap from laser scans.";
    report.commandLine = options.commandLine;
    report.result = result;
    report.config = toYaml(options);
    report.voxels = drawnVoxels(map);
    report.tables = {summary};
    std::vector<NamedFigure> figures;
    if (!result["stations"].empty()) figures.push_back(overview(map, report.title));
    writeResultFolder(folder, report, figures);
}

/// Of this process, so far.
long peakMegabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

}  // namespace

CommandReport runScanMap(const ScanCommandOptions& options, const std::atomic<bool>& interrupted) {
    const std::vector<Scan> scans = openScans(options);  // all headers, before any work
    FolderTransaction folder = beginResult(options.out, {options.scans});

    const Stopwatch watch;
    TexturedOcTree map(options.resolution);
    const auto isStopped = [&] { return interrupted.load(); };
    const json stations = stationsJson(fuseScans(map, scans, options, isStopped, options.progress));
    if (interrupted && keepsEarlierResult(folder, stations.empty())) {
        return {{}, {}, {}, kInterrupted};
    }
    CommandReport report;
    report.result = resultJson("map", {{"interrupted", interrupted.load()},
                                       {"scans", options.scans},
                                       {"stations", stations},
                                       {"resolution", options.resolution},
                                       {"max_range", options.maxRange},
                                       {"voxels", voxelsJson(map)},
                                       {"time", {{"fuse_s", watch.seconds()}}}});
    report.summary = summaryOf(report.result);
    report.exitCode = interrupted                                ? kInterrupted
                      : report.result["voxels"]["occupied"] == 0 ? kNoAnswer
                                                                 : kDone;
    saveTexturedOcTree(map, (folder.path() / "map.ot").string());
    saveColorOcTree(map, (folder.path() / "map_color.ot").string());
    saveBinaryOcTree(map, (folder.path() / "map.bt").string());
    writeScanReport(folder.path(), options, report.result, report.summary, map);
    const long peak = peakMegabytes();  // all work is done, the report is written
    report.result["peak_memory_mb"] = peak;
    report.summary.rows.emplace_back("peak memory", fmt::format("{} MB", peak));
    report.folder = commitResult(folder, report.result);
    return report;
}

}  // namespace photonav
