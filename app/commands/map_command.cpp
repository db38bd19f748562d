// SPDX-License-Identifier: BSD-3-Clause
#include "commands/map_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "commands/command_io.hpp"
#include "commands/result_folder.hpp"
#include "drawing/comparison_images.hpp"
#include "drawing/convergence_figure.hpp"
#include "evaluation/averages.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "map/octree_file.hpp"
#include "mapping/monocular_fusion.hpp"
#include "mapping/view_difference.hpp"
#include "render/voxel_renderer.hpp"
#include "report/map_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kCompared = 4;  // images beside their predictions
constexpr double kNearest = 0.05;     // of depth from the images, which is sought from there on [m]
constexpr const char* kConvergence = "convergence.png";

std::string comparisonName(std::size_t i) { return fmt::format("comparison_{}.png", i); }

/// Of an earlier map in the same folder.
void removeFigures(const fs::path& folder) {
    fs::remove(folder / kConvergence);
    for (std::size_t i = 0; i < kCompared; ++i) fs::remove(folder / comparisonName(i));
}

void checkOptions(const MapOptions& options) {
    const auto require = [](bool good, const char* option, const std::string& reason) {
        if (!good) throw InputError(option, "", reason);
    };
    const auto positive = [&](double value, const char* option) {
        require(std::isfinite(value) && value > 0., option,
                fmt::format("{} is not a positive number", value));
    };
    positive(options.resolution, "--resolution");
    positive(options.fusion.maxRange, "--max-range");
    require(options.fusion.minRange < options.fusion.maxRange, "--max-range",
            fmt::format("not above the least range, {} m", options.fusion.minRange));
    require(options.depth == "recorded" || options.depth == "monocular", "--depth",
            fmt::format("'{}' is not one of recorded, monocular", options.depth));
    require(options.depth == "recorded" || options.fusion.minRange >= kNearest, "--min-range",
            fmt::format("depth from the images begins at {} m or farther", kNearest));
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

ReportFigure figureOf(const ConvergenceFigure& convergence) {
    return {fmt::format("Depth from the images: {} of {} reference images, the depth found, the "
                        "state of every pixel (grey: still open), and the error where depth was "
                        "recorded.",
                        convergence.rows(), convergence.references()),
            convergence.figure().png()};
}

MapRun fuseFrames(const MapOptions& options, const Recording& recording,
                  const std::atomic<bool>& interrupted, TexturedOcTree& map) {
    const Sequence& sequence = recording.sequence;
    MapRun run;
    Stopwatch watch;
    std::optional<MonocularFusion> monocular;
    ConvergenceFigure convergence;
    bool isDepthChecked = false;
    if (options.depth == "monocular") {
        monocular.emplace(map, sequence.camera, options.fusion, [&](const auto& reference) {
            convergence.add(reference.filter, reference.recorded, reference.timestamp);
        });
    }
    const auto add = [&](const RecordedFrame& frame) {
        try {
            if (monocular) {
                monocular->add(frame);
            } else {
                fuse(map, frame.view, sequence.camera, frame.T_c_w, options.fusion);
            }
        } catch (const std::invalid_argument& error) {  // sizes are checked: cells are too small
            throw InputError("--resolution", "", error.what());
        }
    };
    while (run.frames < sequence.frames.size() && !interrupted) {
        const RecordedFrame frame = recording.load(run.frames);
        run.loadSeconds += watch.lap();
        checkPosition(options, frame);
        if (!isDepthChecked) isDepthChecked = checkDepths(options, sequence, frame.view);
        if (isBlack(frame.view.intensity)) {
            run.black.push_back({sequence.frames[run.frames].colourFile, "black"});
        } else {
            add(frame);
        }
        run.fuseSeconds += watch.lap();
        ++run.frames;
        if (options.progress) options.progress(run.frames, sequence.frames.size());
    }
    if (monocular) {
        monocular->finish();
        run.monocular = monocular->result();
        if (convergence.rows() > 0) run.figures.push_back({kConvergence, figureOf(convergence)});
        run.fuseSeconds += watch.lap();
    }
    return run;
}

Trajectory trajectoryOf(const Sequence& sequence, std::size_t count) {
    Trajectory trajectory;
    for (std::size_t i = 0; i < count; ++i) {
        const auto& entry = sequence.frames[i];
        trajectory.push_back({entry.timestamp, entry.T_c_w.inverse()});
    }
    return trajectory;
}

/// Predicts every n-th frame and evaluates the differences; pictures of a few.
void compareFrames(const MapOptions& options, const Recording& recording, const TexturedOcTree& map,
                   const std::atomic<bool>& interrupted, MapRun& run) {
    if (options.compareEvery < 1) return;
    const Sequence& sequence = recording.sequence;
    const VoxelRenderer renderer(map, UnknownPolicy::occupied);
    const auto step = std::size_t(options.compareEvery);
    const std::size_t count = (sequence.frames.size() + step - 1) / step;
    std::size_t pictures = 0;
    View predicted;
    for (std::size_t k = 0; k < count && !interrupted; ++k) {
        const RecordedFrame frame = recording.load(k * step);
        if (isBlack(frame.view.intensity)) continue;
        renderer.render(sequence.camera, frame.T_c_w, predicted);
        const ViewDifference d = compareViews(frame.view, predicted);
        run.compared.push_back({{"timestamp", frame.timestamp},
                                {"predicted", d.predicted},
                                {"mean_abs_intensity", orNull(d.meanIntensity)},
                                {"median_abs_intensity", orNull(d.medianIntensity)},
                                {"contrast", orNull(d.contrast)},
                                {"mean_abs_depth", orNull(d.meanDepth)},
                                {"median_abs_depth", orNull(d.medianDepth)}});
        const std::size_t every = std::max<std::size_t>(1, count / kCompared);
        if (k % every == every / 2 && pictures < kCompared) {
            const auto images = comparisonImages(
                frame.view, predicted, fmt::format("observed at {:.3f} s", frame.timestamp));
            run.figures.push_back(
                {comparisonName(pictures++),
                 {fmt::format("Used frame {}", k * step), imagesFigure({images}).png()}});
        }
    }
}

void writeMaps(const fs::path& folder, const TexturedOcTree& map, const Trajectory& trajectory) {
    saveTexturedOcTree(map, (folder / "map.ot").string());
    saveColorOcTree(map, (folder / "map_color.ot").string());
    saveBinaryOcTree(map, (folder / "map.bt").string());
    writeTrajectory((folder / "trajectory.tum").string(), trajectory);
}

}  // namespace

double defaultMinRange(const std::string& depth) {
    return depth == "monocular" ? DepthFilterOptions().minDepth : FusionOptions().minRange;
}

MapReport runMap(const MapOptions& options, const std::atomic<bool>& interrupted) {
    checkOptions(options);
    Stopwatch watch;
    const RecordingOptions& given = options;
    RecordingOptions asked = given;
    asked.needsDepth = options.depth == "recorded";
    const Recording recording = readRecording(asked);
    const NoEmptyFolder noEmptyFolder(options.out);
    claimFolder(options.out, {options.dataset, options.cameraFile});
    json time{{"read_s", watch.lap()}};

    TexturedOcTree map(options.resolution);
    MapRun run = fuseFrames(options, recording, interrupted, map);
    time["load_images_s"] = run.loadSeconds;
    time["fuse_s"] = run.fuseSeconds;
    time["fuse_per_frame_s"] = run.fuseSeconds / double(std::max<std::size_t>(1, run.frames));
    watch.lap();
    removeFigures(options.out);  // not before: a recording that is refused leaves an old map whole
    run.trajectory = trajectoryOf(recording.sequence, run.frames);
    writeMaps(options.out, map, run.trajectory);
    time["write_s"] = watch.lap();

    compareFrames(options, recording, map, interrupted, run);
    time["compare_s"] = watch.lap();
    run.interrupted = interrupted;
    MapReport report;
    report.result = mapResult(options, recording, run);
    report.result["voxels"] = voxelsJson(map);
    report.result["time"] = time;
    report.summary = mapSummary(report.result);
    report.exitCode = run.interrupted                            ? kInterrupted
                      : report.result["voxels"]["occupied"] == 0 ? kNoAnswer
                                                                 : kDone;
    writeMapReport(options, report.result, recording, map, run);
    writeFileAtomically(options.out / "result.json", report.result.dump(2) + "\n");
    return report;
}

}  // namespace photonav
