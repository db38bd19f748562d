// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/map_info.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "io/error.hpp"
#include "io/reading.hpp"
#include "map/octree_file.hpp"
#include "recordings/map_report.hpp"
#include "result/json_values.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Share of the occupied cells of which a face was observed; 0 when none is occupied.
double shareTextured(const TexturedOcTree& map) {
    double occupied = 0.;
    double textured = 0.;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (!map.isNodeOccupied(*leaf)) continue;
        const double cells = std::pow(leaf.getSize() / map.getResolution(), 3);
        occupied += cells;
        if (leaf->meanGrey()) textured += cells;
    }
    return occupied > 0. ? textured / occupied : 0.;
}

ReportTable factsOf(const json& result) {
    const json& voxels = result["voxels"];
    ReportTable table{"Map",
                      {{"cell", fmt::format("{} m", result["resolution"].get<double>())},
                       {"occupied cells", voxels["occupied"].dump()},
                       {"free cells", voxels["free"].dump()},
                       {"occupied cells with a grey value",
                        fmt::format("{:.1f} %", 100. * result["textured"].get<double>())}}};
    if (!voxels.contains("bounds")) return table;
    constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
    for (std::size_t i = 0; i < kAxes.size(); ++i) {
        table.rows.emplace_back(
            fmt::format("occupied cells along {}", kAxes[i]),
            fmt::format("{:.2f} to {:.2f} m", voxels["bounds"][0][i].get<double>(),
                        voxels["bounds"][1][i].get<double>()));
    }
    return table;
}

}  // namespace

CommandReport runMapInfo(const CommandOptions& options, const std::atomic<bool>& interrupted) {
    if (!options.overrides.empty()) {
        throw InputError("--set", "", "is for a planning problem, not for a map");
    }
    const auto map = loadTexturedOcTree(options.config);
    checkResultFolder(options, "info", interrupted);
    CommandReport report;
    report.result =
        resultJson("info", {{"map", fs::absolute(options.config).lexically_normal().string()},
                            {"resolution", map->getResolution()},
                            {"voxels", voxelsJson(*map)},
                            {"textured", shareTextured(*map)}});
    report.summary = factsOf(report.result);
    ReportData page;
    page.title = fs::path(options.config).filename().string();
    page.subtitle = "What a map holds. Plan in it with map.file in a config.";
    page.commandLine = options.commandLine;
    page.result = report.result;
    page.voxels = drawnVoxels(*map);
    page.tables = {report.summary};
    std::vector<NamedFigure> figures;
    if (report.result["voxels"]["occupied"] > 0)
        figures.push_back(reading(options.config, [&] { return overview(*map, page.title); }));
    FolderTransaction folder = beginResult(options, "info");
    writeResultFolder(folder.path(), page, figures);
    report.folder = commitResult(folder, report.result);
    return report;
}

}  // namespace photonav
