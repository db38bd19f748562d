// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/map_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "figures/convergence_figure.hpp"
#include "io/stopwatch.hpp"
#include "map/octree_file.hpp"
#include "map/surface_cloud.hpp"
#include "recording/view_difference.hpp"
#include "recordings/map_report.hpp"
#include "render/interruptible_views.hpp"
#include "render/voxel_renderer.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostPictures = 40;  // of images beside their predictions

NamedFigure figureOf(const ConvergenceFigure& convergence) {
    return {"convergence",
            fmt::format("Depth from the images: {} of {} reference images, the depth found, the "
                        "state of every pixel (grey: still open), and the error where depth was "
                        "recorded.",
                        convergence.rows(), convergence.references()),
            convergence.figure()};
}

MapRun makeMap(const MapCommandOptions& options, const Recording& recording,
               const std::atomic<bool>& interrupted, TexturedOcTree& map) {
    ConvergenceFigure convergence;
    const auto onReference = [&](const MonocularFusion::Reference& reference) {
        convergence.add(reference.filter, reference.recorded, reference.timestamp);
    };
    MapRun run;
    static_cast<FusedRecording&>(run) =
        fuseRecording(map, recording, options, [&] { return interrupted.load(); },
                      {options.progress, onReference});
    if (convergence.rows() > 0) run.figures.push_back(figureOf(convergence));
    return run;
}

/// Predicts every n-th frame and evaluates the differences; pictures of at most kMostPictures.
void compareFrames(const MapCommandOptions& options, const Recording& recording,
                   const TexturedOcTree& map, const std::atomic<bool>& interrupted, MapRun& run) {
    if (options.compareEvery < 1) return;
    const Sequence& sequence = recording.sequence;
    const InterruptibleViews views(std::make_shared<VoxelRenderer>(map, options.unknownToCamera),
                                   [&] { return interrupted.load(); });
    const auto step = std::size_t(options.compareEvery);
    const std::size_t count = (sequence.frames.size() + step - 1) / step;
    const std::size_t stride = (count + kMostPictures - 1) / kMostPictures;  // of pictures
    View predicted;
    for (std::size_t k = 0; k < count && !interrupted; ++k) {
        if (options.comparison) options.comparison(k, count);
        const RecordedFrame frame = recording.load(k * step);
        if (interrupted) return;
        if (isBlack(frame.view.intensity)) continue;
        views.render(sequence.camera, frame.T_c_w, predicted);
        const ViewDifference d = compareViews(frame.view, predicted);
        run.compared.push_back({{"timestamp", frame.timestamp},
                                {"predicted", d.predicted},
                                {"mean_abs_intensity", orNull(d.meanIntensity)},
                                {"median_abs_intensity", orNull(d.medianIntensity)},
                                {"contrast", orNull(d.contrast)},
                                {"mean_abs_depth", orNull(d.meanDepth)},
                                {"median_abs_depth", orNull(d.medianDepth)}});
        if (interrupted) return;
        if (k % stride == stride / 2) run.pictures.push_back(pictureOf(frame, k * step, predicted));
    }
}

void writeMaps(const fs::path& folder, const TexturedOcTree& map, const Trajectory& trajectory) {
    saveTexturedOcTree(map, (folder / "map.ot").string());
    saveColorOcTree(map, (folder / "map_color.ot").string());
    saveBinaryOcTree(map, (folder / "map.bt").string());
    saveSurfaceCloud(map, (folder / "surfaces.ply").string());
    writeTrajectory((folder / "trajectory.tum").string(), trajectory);
}

}  // namespace

CommandReport runMap(const MapCommandOptions& options, const std::atomic<bool>& interrupted) {
    Stopwatch watch;
    const Recording recording = openForMap(options);
    FolderTransaction folder = beginResult(options.out, {options.dataset, options.cameraFile});
    json time{{"read_s", watch.lap()}};

    TexturedOcTree map(options.resolution);
    MapRun run = makeMap(options, recording, interrupted, map);
    if (interrupted && keepsEarlierResult(folder, run.frames == 0)) {
        return {{}, {}, {}, kInterrupted};
    }
    time["load_images_s"] = run.loadSeconds;
    time["fuse_s"] = run.fuseSeconds;
    time["fuse_per_frame_s"] = run.fuseSeconds / double(std::max<std::size_t>(1, run.frames));
    watch.lap();
    writeMaps(folder.path(), map, run.trajectory);
    time["write_s"] = watch.lap();

    try {
        compareFrames(options, recording, map, interrupted, run);
    } catch (const Interrupted&) {  // the map is whole
    }
    time["compare_s"] = watch.lap();
    run.interrupted = interrupted;
    CommandReport report;
    report.result = mapResult(options, recording, run, run.compared, run.interrupted);
    report.result["voxels"] = voxelsJson(map);
    report.result["time"] = time;
    report.summary = mapSummary(report.result);
    report.exitCode = run.interrupted                            ? kInterrupted
                      : report.result["voxels"]["occupied"] == 0 ? kNoAnswer
                                                                 : kDone;
    writeMapReport(folder.path(), options, report.result, recording, map, run);
    report.folder = commitResult(folder, report.result);
    return report;
}

}  // namespace photonav
