// SPDX-License-Identifier: BSD-3-Clause
#include "map_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atomic_file.hpp"
#include "command_io.hpp"
#include "error.hpp"
#include "map_comparison.hpp"
#include "map_config.hpp"
#include "median.hpp"
#include "monocular_fusion.hpp"
#include "octree_file.hpp"
#include "report.hpp"
#include "sequence_tum.hpp"
#include "stopwatch.hpp"
#include "trajectory.hpp"
#include "voxel_renderer.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kCompared = 4;  // images beside their predictions

void checkOptions(const MapOptions& options) {
    const auto require = [](bool good, const char* option, const std::string& reason) {
        if (!good) throw InputError(option, "", reason);
    };
    const auto positive = [&](double value, const char* option) {
        require(std::isfinite(value) && value > 0., option,
                fmt::format("{} is not a positive number", value));
    };
    positive(options.resolution, "--resolution");
    positive(options.tolerance, "--tolerance");
    positive(options.fusion.maxRange, "--max-range");
    require(options.fusion.minRange < options.fusion.maxRange, "--max-range",
            fmt::format("not above the least range, {} m", options.fusion.minRange));
    if (options.depthScale) positive(*options.depthScale, "--depth-scale");
    require(options.depth == "recorded" || options.depth == "monocular", "--depth",
            fmt::format("'{}' is not one of recorded, monocular", options.depth));
    require(options.every >= 1, "--every", "must be at least 1");
}

/// Cells are numbered by 16 bits an axis: far from the origin there are none. Nearer than kNear it
/// is the cells that are too small.
void checkPosition(const MapOptions& options, const RecordedFrame& frame) {
    const double farthest = frame.T_c_w.inverse().translation().cwiseAbs().maxCoeff();
    const double reach = 32768. * options.resolution;
    constexpr double kNear = 100.;
    if (farthest <= std::max(reach, kNear)) return;
    throw InputError(
        (fs::path(options.dataset) / "groundtruth.txt").string(),
        fmt::format("{:.6f} s", frame.timestamp),
        fmt::format("the camera is {:.6g} m from the origin, a map with cells of {} m ends at {} m",
                    farthest, options.resolution, reach));
}

struct FusedFrames {
    std::size_t count = 0;  ///< less than all when interrupted
    double loadSeconds = 0.;
    double fuseSeconds = 0.;
    json monocular;  ///< how good its depths are, null when they were recorded
};

/// Looks at one frame with recorded depth. @returns whether it had any
bool checkDepths(const MapOptions& options, const Sequence& sequence, const View& view) {
    std::vector<float> depths;
    for (unsigned k = 0; k < view.depth.getSize(); ++k) {
        if (view.depth.bitmap[k] > 0.F) depths.push_back(view.depth.bitmap[k]);
    }
    if (depths.empty()) return false;
    requirePlausibleDepth(median(std::move(depths), 0.), options, sequence.cameraFile);
    return true;
}

FusedFrames fuseFrames(const MapOptions& options, const Sequence& sequence,
                       const std::atomic<bool>& interrupted, TexturedOcTree& map) {
    FusedFrames fused;
    Stopwatch watch;
    std::optional<MonocularFusion> monocular;
    bool isDepthChecked = false;
    if (options.depth == "monocular") monocular.emplace(map, sequence.camera, options.fusion);
    while (fused.count < sequence.frames.size() && !interrupted) {
        const RecordedFrame frame = loadFrame(sequence, fused.count);
        fused.loadSeconds += watch.lap();
        checkPosition(options, frame);
        if (!monocular && !isDepthChecked) {
            isDepthChecked = checkDepths(options, sequence, frame.view);
        }
        try {
            if (monocular) {
                monocular->add(frame);
            } else {
                fuse(map, frame.view, sequence.camera, frame.T_c_w, options.fusion);
            }
        } catch (const std::invalid_argument& error) {  // sizes are checked: cells are too small
            throw InputError("--resolution", "", error.what());
        }
        fused.fuseSeconds += watch.lap();
        ++fused.count;
        if (options.progress) options.progress(fused.count, sequence.frames.size());
    }
    if (monocular) {
        monocular->finish();
        fused.monocular = monocular->result();
        fused.fuseSeconds += watch.lap();
    }
    return fused;
}

Trajectory trajectoryOf(const Sequence& sequence, std::size_t count) {
    Trajectory trajectory;
    for (std::size_t i = 0; i < count; ++i) {
        const auto& entry = sequence.frames[i];
        trajectory.push_back({entry.timestamp, entry.T_c_w.inverse()});
    }
    return trajectory;
}

struct Strip {
    std::size_t index;
    Png picture;
};

/// Predicts every n-th frame and says how well; keeps strips of a few.
json compareFrames(const MapOptions& options, const Sequence& sequence, const TexturedOcTree& map,
                   const std::atomic<bool>& interrupted, std::vector<Strip>& strips) {
    if (options.compareEvery < 1) return json::array();
    const VoxelRenderer renderer(map, UnknownPolicy::occupied);
    const auto step = std::size_t(options.compareEvery);
    const std::size_t count = (sequence.frames.size() + step - 1) / step;
    json compared = json::array();
    View predicted;
    for (std::size_t k = 0; k < count && !interrupted; ++k) {
        const RecordedFrame frame = loadFrame(sequence, k * step);
        renderer.render(sequence.camera, frame.T_c_w, predicted);
        const ViewDifference d = compareViews(frame.view, predicted);
        compared.push_back({{"timestamp", frame.timestamp},
                            {"predicted", d.predicted},
                            {"mean_abs_intensity", d.meanIntensity},
                            {"median_abs_intensity", d.medianIntensity},
                            {"contrast", d.contrast},
                            {"mean_abs_depth", d.meanDepth},
                            {"median_abs_depth", d.medianDepth}});
        const std::size_t every = std::max<std::size_t>(1, count / kCompared);
        if (k % every == every / 2 && strips.size() < kCompared) {
            strips.push_back(
                {k * step, panelsPng({comparisonPanels(
                               frame.view, predicted,
                               fmt::format("observed at {:.3f} s", frame.timestamp))})});
        }
    }
    return compared;
}

json meansOf(const json& compared) {
    json means = json::object();
    for (const auto& frame : compared) {
        for (const auto& [key, value] : frame.items()) {
            if (key == "timestamp") continue;
            means[key] = means.value(key, 0.) + value.get<double>() / double(compared.size());
        }
    }
    return means;
}

json vectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json datasetJson(const MapOptions& options, const Recording& recording) {
    const Sequence& sequence = recording.sequence;
    const Camera& camera = sequence.camera;
    const Eigen::Matrix3d R = worldUpRotation(recording.up);
    return {{"folder", fs::absolute(options.dataset).lexically_normal().string()},
            {"camera",
             {{"width", camera.width},
              {"height", camera.height},
              {"fx", camera.fx()},
              {"fy", camera.fy()},
              {"cx", camera.cx()},
              {"cy", camera.cy()},
              {"assumed", sequence.cameraAssumed},
              {"depth_registered_here", sequence.depthIntrinsics.has_value()}}},
            {"depth_scale", sequence.depthScale},
            {"up", options.up},
            {"up_direction", vectorJson(recording.up)},
            {"tilt_degrees", tiltDegrees(recording.up)},
            {"map_from_recorded_rotation",
             {vectorJson(R.row(0)), vectorJson(R.row(1)), vectorJson(R.row(2))}}};
}

json framesJson(const MapOptions& options, const Recording& recording, std::size_t used) {
    json skipped = json::array();
    for (const auto& [file, reason] : recording.sequence.skipped) {
        skipped.push_back({{"file", file}, {"reason", reason}});
    }
    return {{"recorded", recording.recorded},
            {"used", used},
            {"every", options.every},
            {"range", options.frames},
            {"skipped", skipped}};
}

ReportTable summary(const json& result) {
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
         {"up in the recorded world",
          fmt::format("{}, {:.1f} degrees from an axis", result["dataset"]["up"].get<std::string>(),
                      result["dataset"]["tilt_degrees"].get<double>())},
         {"cell", fmt::format("{} m", result["resolution"].get<double>())},
         {"occupied cells", result["voxels"]["occupied"].dump()},
         {"free cells", result["voxels"]["free"].dump()},
         {"predicted pixels", number("predicted", 100., "{:.1f} %")},
         {"mean absolute difference of grey values", number("mean_abs_intensity", 1., "{:.4f}")},
         {"the same for one uniform grey", number("contrast", 1., "{:.4f}")},
         {"mean absolute difference of depth", number("mean_abs_depth", 1., "{:.4f} m")},
         {"fusion of one frame",
          fmt::format("{:.1f} ms", result["time"]["fuse_per_frame_s"].get<double>() * 1e3)}}};
    const json& mono = result["monocular"];
    if (mono.is_object() && mono["median_relative_error"].is_number()) {
        table.rows.emplace_back("depth from the images, of recorded pixels",
                                fmt::format("{:.1f} %, error {:.1f} % (median), {:.1f} % (p90)",
                                            100. * mono["completeness"].get<double>(),
                                            100. * mono["median_relative_error"].get<double>(),
                                            100. * mono["p90_relative_error"].get<double>()));
    }
    return table;
}

DrawnPath flown(const Trajectory& trajectory) {
    DrawnPath path;
    path.name = "camera";
    for (const auto& stamped : trajectory) {
        PathPoint point;
        point.T_w_c = stamped.T_w_c;
        point.position = stamped.T_w_c.translation();
        if (!path.points.empty()) {
            const PathPoint& before = path.points.back();
            point.distance = before.distance + (point.position - before.position).norm();
        }
        path.points.push_back(point);
    }
    return path;
}

void writeMapReport(const MapOptions& options, const json& result, const Recording& recording,
                    const Trajectory& trajectory, const TexturedOcTree& map,
                    const std::vector<Strip>& strips) {
    const Camera& camera = recording.sequence.camera;
    ReportData report;
    report.title = "Map of " + fs::path(options.dataset).lexically_normal().filename().string();
    report.subtitle = "A textured OctoMap, and what it predicts where the camera was.";
    report.commandLine = options.commandLine;
    report.version = PHOTONAV_VERSION;
    report.result = result;
    report.config = toYaml(options, recording);
    report.voxels = makeReportVoxels(map);
    report.paths = {flown(trajectory)};
    report.start = trajectory.front().T_w_c.translation();
    report.goal = trajectory.back().T_w_c.translation();
    report.fieldOfView = {2. * std::atan(0.5 * camera.width / camera.fx()),
                          2. * std::atan(0.5 * camera.height / camera.fy())};
    for (const auto& strip : strips) {
        report.figures.push_back({fmt::format("Used frame {}", strip.index), strip.picture});
    }
    report.tables = {summary(result)};
    writeFileAtomically(options.out / "report.json", toJson(report).dump());
    writeReport(options.out / "report.html", report);
}

/// A dataset that cannot be fused leaves no new folder behind.
FusedFrames fuseOrCleanUp(const MapOptions& options, const Sequence& sequence,
                          const std::atomic<bool>& interrupted, TexturedOcTree& map) {
    try {
        return fuseFrames(options, sequence, interrupted, map);
    } catch (const InputError&) {
        std::error_code ignored;
        fs::remove(options.out, ignored);  // only when there is nothing in it
        throw;
    }
}

void writeMaps(const fs::path& folder, const TexturedOcTree& map, const Trajectory& trajectory) {
    saveTexturedOcTree(map, (folder / "map.ot").string());
    saveColorOcTree(map, (folder / "map_color.ot").string());
    saveBinaryOcTree(map, (folder / "map.bt").string());
    writeTrajectory((folder / "trajectory.tum").string(), trajectory);
}

/// result.json but for the map and the time it took.
json resultOf(const MapOptions& options, const Recording& recording, const FusedFrames& fused,
              const json& compared, bool interrupted) {
    return {{"schema", 1},
            {"command", "map"},
            {"version", PHOTONAV_VERSION},
            {"interrupted", interrupted},
            {"dataset", datasetJson(options, recording)},
            {"frames", framesJson(options, recording, fused.count)},
            {"depth", options.depth},
            {"monocular", fused.monocular},
            {"resolution", options.resolution},
            {"min_range", options.fusion.minRange},
            {"max_range", options.fusion.maxRange},
            {"comparison", {{"mean", meansOf(compared)}, {"frames", compared}}}};
}

}  // namespace

json voxelsJson(const TexturedOcTree& map) {
    std::size_t free = 0;
    std::size_t occupied = 0;
    Eigen::AlignedBox3d box;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        const std::size_t cells = std::size_t(1) << (3 * (map.getTreeDepth() - leaf.getDepth()));
        if (!map.isNodeOccupied(*leaf)) {
            free += cells;
            continue;
        }
        occupied += cells;
        const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * leaf.getSize());
        box.extend(center - half);
        box.extend(center + half);
    }
    json result = {{"occupied", occupied}, {"free", free}};
    if (!box.isEmpty()) result["bounds"] = {vectorJson(box.min()), vectorJson(box.max())};
    return result;
}

MapReport runMap(const MapOptions& options, const std::atomic<bool>& interrupted) {
    checkOptions(options);
    Stopwatch watch;
    const Recording recording = readRecording(options);
    prepareFolder(options.out);
    json time{{"read_s", watch.lap()}};

    TexturedOcTree map(options.resolution);
    const FusedFrames fused = fuseOrCleanUp(options, recording.sequence, interrupted, map);
    time["load_images_s"] = fused.loadSeconds;
    time["fuse_s"] = fused.fuseSeconds;
    time["fuse_per_frame_s"] = fused.fuseSeconds / double(std::max<std::size_t>(1, fused.count));
    watch.lap();
    const Trajectory trajectory = trajectoryOf(recording.sequence, fused.count);
    writeMaps(options.out, map, trajectory);
    time["write_s"] = watch.lap();

    std::vector<Strip> strips;
    const json compared = compareFrames(options, recording.sequence, map, interrupted, strips);
    time["compare_s"] = watch.lap();
    const bool stopped = interrupted;
    MapReport report;
    report.result = resultOf(options, recording, fused, compared, stopped);
    report.result["voxels"] = voxelsJson(map);
    report.result["time"] = time;
    report.summary = summary(report.result);
    report.exitCode = stopped                                    ? kInterrupted
                      : report.result["voxels"]["occupied"] == 0 ? kNoAnswer
                                                                 : kDone;
    for (std::size_t i = 0; i < strips.size(); ++i) {
        writeFileAtomically(options.out / fmt::format("comparison_{}.png", i), strips[i].picture);
    }
    writeFileAtomically(options.out / "config.yaml", toYaml(options, recording));
    writeFileAtomically(options.out / "result.json", report.result.dump(2) + "\n");
    if (fused.count > 0) writeMapReport(options, report.result, recording, trajectory, map, strips);
    return report;
}

}  // namespace photonav
