// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/replay_command.hpp"

#include "io/atomic_file.hpp"
#include "io/stopwatch.hpp"
#include "recordings/replay_report.hpp"
#include "render/area_sensor.hpp"
#include "replay/blur_estimate.hpp"
#include "replay/calibration_file.hpp"
#include "replay/replay.hpp"
#include "replay/replay_calibration.hpp"
#include "replay/replay_config.hpp"
#include "replay/replay_files.hpp"
#include "replay/replay_tables.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Fits a calibration, and writes it if there is enough to fit it to. @returns its entry of
/// result.json
json calibrateReplay(const fs::path& folder, const ReplayRun& run, const Replay& replay) {
    const MapKind map = replay.map().kind;
    const bool leastSigmaOnly = !run.odometry && map != MapKind::mesh;
    const auto calibration = calibrationOf(run, leastSigmaOnly);
    if (!calibration) return nullptr;
    writeFileAtomically(folder / "calibration.yaml",
                        toYaml(*calibration, run.odometry ? std::nullopt : std::optional(map)));
    return {{"scale", calibration->scale},
            {"least_sigma", {calibration->leastSigma, calibration->leastSigmaRotation}},
            {"correlation_time", calibration->correlationTime},
            {"depth_error", orNull(depthErrorOf(run, replay.depthError().relative))},
            {"nees_before", calibration->neesBefore},
            {"nees_after", calibration->neesAfter}};
}

/// Point spreads in pixels of the recording.
json blurJson(const std::optional<BlurEstimate>& estimate, double assumed) {
    json blur{{"assumed", assumed}, {"estimated", nullptr}};
    if (!estimate) return blur;
    blur["estimated"] = estimate->blur;
    blur["variance_sigma"] = estimate->sigma;
    blur["contradicts"] = estimate->contradicts(assumed);
    return blur;
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
    keys.flag({"calibrate", "", "also fit scale, least sigmas and depth error to the errors"},
              options.calibrate);
    return keys;
}

CommandReport runReplay(const ReplayCommandOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Replay replay(options);
    FolderTransaction folder = beginResult(
        options.out, {options.dataset, options.cameraFile, options.mapFile, options.calibration});

    const Sequence& sequence = replay.recording().sequence;
    const ReplayRun run = replay.run([&] { return interrupted.load(); },
                                     [&](std::size_t done) {
                                         if (options.progress)
                                             options.progress(done, sequence.frames.size());
                                     });
    if (run.interrupted && keepsEarlierResult(folder, run.frames.empty())) {
        return {{}, {}, {}, kInterrupted};
    }
    const ReplayErrors errors = evaluate(run);

    CommandReport report;
    report.exitCode = run.interrupted ? kInterrupted : isLostForGood(run) ? kNoAnswer : kDone;
    json& result = report.result;
    result = resultJson("replay", replayResult(sequence, run, errors));
    result["interrupted"] = run.interrupted;
    result["mode"] = modeOf(run.odometry ? std::nullopt : std::optional(replay.map().kind));
    result["options"] = optionsJson(replay.options());
    result["dataset"] = datasetJson(replay);
    result["time"] = {{"total_s", watch.seconds()},
                      {"load_images_s", run.loadSeconds},
                      {"track_s", run.trackSeconds}};
    if (options.calibrate) {
        result["calibration"] = calibrateReplay(folder.path(), run, replay);
    }
    if (!run.odometry && replay.map().kind == MapKind::mesh) {
        result["blur"] = blurJson(estimateBlur(run), sequence.blur.value_or(kAreaBlur));
    }
    report.summary = replaySummary(result);
    writeReplayTables(folder.path(), run, errors);
    writeColmap(folder.path(), replay, run);
    writeReplayReport(folder.path(), options, configOf(options, replay), result, replay, run,
                      errors);
    report.folder = commitResult(folder, result);
    return report;
}

}  // namespace photonav
