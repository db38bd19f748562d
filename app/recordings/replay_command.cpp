// SPDX-License-Identifier: BSD-3-Clause
#include "commands/replay_command.hpp"

#include "commands/command_io.hpp"
#include "commands/result_folder.hpp"
#include "dataset/colmap_model.hpp"
#include "io/atomic_file.hpp"
#include "io/stopwatch.hpp"
#include "replay/calibration_file.hpp"
#include "replay/replay.hpp"
#include "replay/replay_calibration.hpp"
#include "replay/replay_config.hpp"
#include "replay/replay_tables.hpp"
#include "report/replay_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json optionsJson(const ReplayOptions& o) {
    return {{"mode", o.odometry ? "odometry" : "map"},
            {"map", o.mapFile},
            {"every", o.every},
            {"frames", o.frames},
            {"up", o.up},
            {"tolerance_s", o.tolerance},
            {"camera", o.cameraFile},
            {"depth_scale", orNull(o.depthScale)},
            {"stereo", o.stereo.empty() ? json(nullptr) : json(o.stereo)},
            {"topics", o.topics},
            {"mount", o.mount},
            {"start", o.start},
            {"start_sigma", orNull(o.startSigma)},
            {"sigma", o.sigma},
            {"scale", *o.scale},
            {"least_sigma", {*o.leastSigma, *o.leastSigmaRotation}},
            {"min_overlap", o.minOverlap},
            {"max_width", o.maxWidth ? json(*o.maxWidth) : json(nullptr)},
            {"exposure", o.exposure}};
}

json datasetJson(const Replay& replay) {
    const Recording& recording = replay.recording();
    return {{"folder", fs::absolute(replay.options().dataset).lexically_normal().string()},
            {"layout", recording.layout},
            {"note", recording.note},
            {"median_depth_m", orNull(replay.medianDepth())},
            {"depth_noise_m", replay.depthNoise()},
            {"depth_error", replay.depthError().relative},
            {"depth_error_assumed", replay.depthError().isAssumed},
            {"camera", cameraJson(recording.sequence.camera)}};
}

/// Fits a calibration, and writes it if there is enough to fit it to. @returns its entry of
/// result.json
json calibrateReplay(const fs::path& folder, const ReplayRun& run, MapKind map) {
    const bool leastSigmaOnly = !run.odometry && map != MapKind::mesh;
    const auto calibration = calibrationOf(run, leastSigmaOnly);
    if (!calibration) return nullptr;
    writeFileAtomically(folder / "calibration.yaml",
                        toYaml(*calibration, run.odometry ? std::nullopt : std::optional(map)));
    return {{"scale", calibration->scale},
            {"least_sigma", {calibration->leastSigma, calibration->leastSigmaRotation}},
            {"correlation_time", calibration->correlationTime},
            {"nees_before", calibration->neesBefore},
            {"nees_after", calibration->neesAfter}};
}

/// The images that were tracked with their estimated poses, as a model of COLMAP: their files are
/// named as from the folder of the dataset. Rectified images, and those of a bag, are no files.
void writeColmap(const fs::path& folder, const Replay& replay, const ReplayRun& run) {
    const Recording& recording = replay.recording();
    if (!recording.hasImageFiles) return;
    const fs::path dataset = fs::absolute(replay.options().dataset).lexically_normal();
    std::vector<ColmapImage> images;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status != FrameStatus::tracked) continue;
        const fs::path file = recording.sequence.frames[frame.index].colourFile;
        images.push_back(
            {fs::absolute(file).lexically_relative(dataset).string(), frame.tracked.T_c_w.mean});
    }
    writeColmapModel(folder.string(), recording.sequence.camera, images);
}

/// Everything the replay depended on, with the values in use.
std::string configOf(const ReplayCommandOptions& options, const Replay& replay) {
    ReplayCommandOptions used = options;
    static_cast<ReplayOptions&>(used) = replay.options();
    return keysOf(used).toYaml();
}

}  // namespace

KeyTable keysOf(ReplayCommandOptions& options) {
    KeyTable keys;
    addKeys(keys, static_cast<ReplayOptions&>(options));
    keys.flag({"calibrate", "", "also fit scale and least sigmas to the errors"},
              options.calibrate);
    return keys;
}

ReplayReport runReplay(const ReplayCommandOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Replay replay(options);
    FolderTransaction folder =
        beginResult(options.out, {options.dataset, options.cameraFile, options.mapFile});

    const Sequence& sequence = replay.recording().sequence;
    const ReplayRun run = replay.run([&] { return interrupted.load(); },
                                     [&](std::size_t done) {
                                         if (options.progress)
                                             options.progress(done, sequence.frames.size());
                                     });
    const ReplayErrors errors = evaluate(run);

    ReplayReport report;
    report.exitCode = run.interrupted ? kInterrupted : isLostForGood(run) ? kNoAnswer : kDone;
    json& result = report.result;
    result = replayResult(sequence, run, errors);
    result["schema"] = 1;
    result["command"] = "replay";
    result["version"] = PHOTONAV_VERSION;
    result["interrupted"] = run.interrupted;
    result["options"] = optionsJson(replay.options());
    result["dataset"] = datasetJson(replay);
    result["time"] = {{"total_s", watch.seconds()},
                      {"load_images_s", run.loadSeconds},
                      {"track_s", run.trackSeconds}};
    if (options.calibrate) {
        result["calibration"] = calibrateReplay(folder.path(), run, replay.map().kind);
    }
    report.summary = replaySummary(result);
    writeReplayTables(folder.path(), run, errors);
    writeColmap(folder.path(), replay, run);
    writeReplayReport(folder.path(), options, configOf(options, replay), result, replay, run,
                      errors);
    commitResult(folder, result);
    return report;
}

}  // namespace photonav
