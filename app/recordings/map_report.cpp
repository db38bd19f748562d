// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/map_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "figures/comparison_images.hpp"
#include "figures/perspective.hpp"
#include "io/atomic_file.hpp"
#include "mapping/map_config.hpp"
#include "render/voxel_renderer.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr Color kCameraColor = kIndigo;
constexpr std::size_t kFiles = 4;  // of pictures, in the result folder

using TableRows = std::vector<std::pair<std::string, std::string>>;

/// Statistics of the depth from one camera; none when depth was recorded.
TableRows depthRows(const json& mono) {
    if (!mono.is_object()) return {};
    const auto percent = [&](const char* key) {
        return fmt::format("{:.1f} %", 100. * mono[key].get<double>());
    };
    TableRows rows{{"reference images with depth from the images",
                    fmt::format("{}, and {} given up", mono["references"].get<int>(),
                                mono["references_given_up"].get<int>())}};
    if (mono["converged"].is_number()) {
        rows.emplace_back("pixels converged, given up, still open",
                          fmt::format("{}, {}, {}", percent("converged"), percent("given_up"),
                                      percent("searching")));
    }
    if (mono["completeness"].is_number()) {
        rows.emplace_back("completeness, of the recorded pixels", percent("completeness"));
    }
    if (mono["median_relative_error"].is_number()) {
        rows.emplace_back(
            "relative error of depth, median, p90",
            fmt::format("{}, {}", percent("median_relative_error"), percent("p90_relative_error")));
    }
    return rows;
}

const char* whyEmpty(const json& result) {
    const std::size_t used = result["frames"]["used"];
    if (used == 0 && result["frames"]["black"] > 0) return "all images are black";
    if (result["depth"] == "monocular") {
        return used == 1 ? "depth is measured from image to image, and there is only one"
                         : "the camera moves too little to measure depth, or there is no texture";
    }
    return "no surface was found";
}

DrawnPath cameraPath(const Trajectory& trajectory) {
    DrawnPath path{"camera", kCameraColor};
    for (const auto& stamped : trajectory)
        append(path, {.position = stamped.T_w_c.translation(), .T_w_c = stamped.T_w_c});
    return path;
}

/// A few of the pictures as files, which the page does not show a second time.
void writePictures(const fs::path& folder, const std::vector<ReportFrame>& pictures) {
    const std::size_t count = std::min(kFiles, pictures.size());
    for (std::size_t i = 0; i < count; ++i) {
        writeFileAtomically(folder / fmt::format("comparison_{}.png", i),
                            pictures[i * pictures.size() / count].image);
    }
}

}  // namespace

ReportFrame pictureOf(const RecordedFrame& frame, std::size_t number, const View& predicted) {
    const auto images = comparisonImages(frame.view, predicted,
                                         fmt::format("observed at {:.3f} s", frame.timestamp));
    ReportFrame picture{fmt::format("Used frame {}", number), imagesFigure({images}, 400.).png()};
    picture.believed = makePathPoint({frame.T_c_w, Matrix6::Zero()}, 0., 0., 0.);
    picture.color = kCameraColor;
    return picture;
}

NamedFigure overview(const TexturedOcTree& map, const std::string& title) {
    Eigen::AlignedBox3d box;
    map.getMetricMin(box.min().x(), box.min().y(), box.min().z());
    map.getMetricMax(box.max().x(), box.max().y(), box.max().z());
    return {"overview", "The map in perspective.",
            perspectiveFigure(VoxelRenderer(map, UnknownPolicy::free), {title, box, {}})};
}

ReportTable mapSummary(const json& result) {
    const auto& means = result["comparison"]["mean"];
    const auto number = [&](const char* key, double factor, const char* format) {
        if (!means.contains(key)) return std::string("not compared");
        return fmt::format(fmt::runtime(format), factor * means[key].get<double>());
    };
    const auto& frames = result["frames"];
    ReportTable table{
        "Map",
        {{"frames used", fmt::format("{} of {}", frames["used"].get<std::size_t>(),
                                     frames["recorded"].get<std::size_t>())},
         {"upward direction of the recorded world",
          fmt::format("{}, {:.1f} degrees from an axis", result["dataset"]["up"].get<std::string>(),
                      result["dataset"]["tilt_degrees"].get<double>())},
         {"cell", fmt::format("{} m", result["resolution"].get<double>())},
         {"occupied cells", result["voxels"]["occupied"].dump()},
         {"free cells", result["voxels"]["free"].dump()},
         {"predicted pixels", number("predicted", 100., "{:.1f} %")},
         {"mean absolute difference of grey values", number("mean_abs_intensity", 1., "{:.4f}")},
         {"mean absolute difference of the best uniform grey", number("contrast", 1., "{:.4f}")},
         {"mean absolute difference of depth", number("mean_abs_depth", 1., "{:.4f} m")},
         {"fusion of one frame",
          fmt::format("{:.1f} ms", result["time"]["fuse_per_frame_s"].get<double>() * 1e3)}}};
    if (result["voxels"]["occupied"] == 0) {
        table.rows.emplace(table.rows.begin(), "verdict",
                           fmt::format("the map is empty: {}", whyEmpty(result)));
    }
    for (auto& row : depthRows(result["monocular"])) table.rows.push_back(std::move(row));
    return table;
}

void writeMapReport(const std::filesystem::path& folder, const MapCommandOptions& options,
                    const json& result, const Recording& recording, const TexturedOcTree& map,
                    const MapRun& run) {
    ReportData report;
    report.title = "Map of " + fs::path(options.dataset).lexically_normal().filename().string();
    report.subtitle = "A textured OctoMap, and its predictions at the recorded poses.";
    report.commandLine = options.commandLine;
    report.result = result;
    report.config = toYaml(options, recording);
    report.voxels = drawnVoxels(map);
    if (!run.trajectory.empty()) {
        report.paths = {cameraPath(run.trajectory)};
        report.start = run.trajectory.front().T_w_c.translation();
        report.goal = run.trajectory.back().T_w_c.translation();
    }
    report.fieldOfView = fieldOfView(recording.sequence.camera);
    report.tables = {mapSummary(result)};
    report.frames = run.pictures;
    writePictures(folder, run.pictures);
    writeResultFolder(folder, report, run.figures);
}

}  // namespace photonav
