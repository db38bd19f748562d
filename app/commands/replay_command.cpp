// SPDX-License-Identifier: BSD-3-Clause
#include "commands/replay_command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <sstream>

#include "commands/command_io.hpp"
#include "commands/replay_config.hpp"
#include "commands/result_folder.hpp"
#include "estimation/calibration.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "report/replay_report.hpp"
#include "result/json_values.hpp"
#include "runs/replay_calibration.hpp"
#include "runs/replay_run.hpp"
#include "runs/tracking_map.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kWidthInMap = 320;  // [pixels]

void checkOptions(const ReplayOptions& options) {
    const auto require = [](bool good, const char* option, const std::string& reason) {
        if (!good) throw InputError(option, "", reason);
    };
    const auto isPositive = [](double x) { return std::isfinite(x) && x > 0.; };
    require(options.odometry || !options.mapFile.empty(), "--map",
            "needed, or --odometry: nothing to find the camera in");
    require(!options.odometry || options.mapFile.empty(), "--odometry", "not together with --map");
    require(isPositive(options.sigma), "--sigma", "must be above 0");
    require(!options.startSigma || !options.odometry, "--start-sigma",
            "is for --map: odometry is exact where it begins");
    require(isPositive(options.startSigma.value_or(kStartSigma)), "--start-sigma",
            "must be above 0");
    require(!options.scale || isPositive(*options.scale), "--scale", "must be above 0");
    const auto isFloor = [](const std::optional<double>& x) {
        return !x || (std::isfinite(*x) && *x >= 0.);
    };
    require(isFloor(options.floorTranslation), "--sigma-floor", "must be a number, not negative");
    require(isFloor(options.floorRotation), "--sigma-floor-rotation",
            "must be a number, not negative");
    require(options.minOverlap > 0. && options.minOverlap < 1., "--min-overlap",
            "must be between 0 and 1");
    require(options.maxWidth.value_or(kWidthInMap) >= kLeastWidth, "--max-width",
            fmt::format("must be at least {}", kLeastWidth));
}

Pose parsePose(const std::string& text) {
    std::istringstream in(text);
    Eigen::Matrix<double, 7, 1> v;
    for (int i = 0; i < 7; ++i) {
        char comma = ',';
        if (i > 0) in >> comma;
        in >> v[i];
        if (!in || comma != ',') {
            throw InputError("--start", "", fmt::format("'{}' is not x,y,z,qx,qy,qz,qw", text));
        }
    }
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (!(in >> std::ws).eof() || !v.allFinite() || std::abs(q.norm() - 1.) > 0.1) {
        throw InputError("--start", "",
                         fmt::format("'{}' is not x,y,z,qx,qy,qz,qw with a unit quaternion", text));
    }
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() = q.normalized().toRotationMatrix();
    T_w_c.translation() = v.head<3>();
    return T_w_c;
}

UncertainPose startOf(const ReplayOptions& options, const ReplaySource& source) {
    UncertainPose start;
    if (!options.odometry) {
        const double sigma = options.startSigma.value_or(kStartSigma);
        start.covariance = sigma * sigma * Matrix6::Identity();
    }
    if (!options.start.empty()) {
        start.mean = parsePose(options.start).inverse();
        if (options.odometry && source.hasGroundtruth()) {
            throw InputError("--start", "",
                             "not with --odometry of a recording with ground truth: it is laid on "
                             "that where it begins");
        }
    } else if (!options.odometry) {
        if (!source.frames[0].T_c_w) {
            throw InputError(
                options.dataset, "--start",
                source.hasGroundtruth()
                    ? "needed: the first frame has no true pose (or begin later with --frames)"
                    : "needed: the recording has no ground truth to begin from");
        }
        start.mean = *source.frames[0].T_c_w;
    }
    return start;
}

std::optional<double> checkDepths(const ReplayOptions& options, const ReplaySource& source) {
    const std::optional<double> depth = medianDepth(source);
    if (!depth) return {};
    if (*depth > 0.) {
        requirePlausibleDepth(*depth, options, source.cameraFile);
        return depth;
    }
    // Black images have no depth from stereo, and replaying them says what they are.
    if (options.odometry && source.stereo.empty()) {
        throw InputError(options.dataset, "", "no depth in any of the images looked at");
    }
    return {};
}

void setWidth(KeyframeOptions& keyframe, const Camera& camera, int maxWidth) {
    keyframe.finest = 0;
    while (static_cast<int>(camera.width >> keyframe.finest) > maxWidth) ++keyframe.finest;
    // Of all pixels only those that tell something: faster, and as accurate (docs/replay.md).
    if (keyframe.finest == 0) keyframe.minGradient = 0.02;
}

ReplayTracker makeTracker(const ReplayOptions& options, const ReplaySource& source,
                          const TrackingMap& map) {
    const UncertainPose start = startOf(options, source);
    const auto set = [&](AlignmentOptions& alignment) {
        alignment.photometric.sigma = options.sigma;
        if (!options.exposure) {
            alignment.exposure.reset();
        } else if (!alignment.exposure) {
            alignment.exposure.emplace();
        }
        alignment.robust = RobustWeight::huber;
        alignment.trust.minOverlap = options.minOverlap;
        if (options.scale) alignment.photometric.scale = *options.scale;
        if (options.floorTranslation) alignment.trust.floorTranslation = *options.floorTranslation;
        if (options.floorRotation) alignment.trust.floorRotation = *options.floorRotation;
    };
    if (options.odometry) {
        KeyframeChainOptions odometry;
        set(odometry.keyframe.alignment);
        if (options.maxWidth) setWidth(odometry.keyframe, source.camera, *options.maxWidth);
        return odometryTracker(source.camera, start, odometry);
    }
    TrackerOptions tracker;
    tracker.map = realCameraOptions(map.resolution());
    // The motion is only guessed, so that nothing else stops a pose from sliding away.
    tracker.map.trust.maxUnexplained = 0.25;
    if (source.informationScale) tracker.map.photometric.scale = *source.informationScale;
    set(tracker.map);
    return mapTracker(map.views, source.camera, start, tracker,
                      static_cast<unsigned>(options.maxWidth.value_or(kWidthInMap)));
}

json optionsJson(const ReplayOptions& o, const ReplaySource& source, const ReplayTracker& tracker) {
    return {{"mode", o.odometry ? "odometry" : "map"},
            {"map", o.mapFile},
            {"every", o.every},
            {"frames", o.frames},
            {"up", o.up},
            {"tolerance_s", o.tolerance},
            {"camera", o.cameraFile},
            {"depth_scale", orNull(o.depthScale)},
            {"stereo", source.stereo.empty() ? json(nullptr) : json(source.stereo)},
            {"start", o.start},
            {"start_sigma", o.odometry ? json(nullptr) : json(o.startSigma.value_or(kStartSigma))},
            {"sigma", o.sigma},
            {"scale", tracker.scale},
            {"floor", {tracker.trust.floorTranslation, tracker.trust.floorRotation}},
            {"min_overlap", o.minOverlap},
            {"max_width", o.maxWidth ? json(*o.maxWidth) : json(nullptr)},
            {"exposure", o.exposure}};
}

json datasetJson(const ReplayOptions& options, const ReplaySource& source,
                 const std::optional<double>& depth) {
    return {{"folder", fs::absolute(options.dataset).lexically_normal().string()},
            {"layout", source.layout},
            {"note", source.note},
            {"median_depth_m", orNull(depth)},
            {"camera", cameraJson(source.camera)}};
}

void calibrateReplay(const ReplayOptions& options, const ReplayRun& run, double scale,
                     bool floorOnly, json& result) {
    const auto calibration = calibrationOf(run, options.odometry, scale, floorOnly);
    result["calibration"] = nullptr;
    if (!calibration) return;
    result["calibration"] = {{"scale", calibration->scale},
                             {"floor", {calibration->floorTranslation, calibration->floorRotation}},
                             {"correlation_time", calibration->correlationTime},
                             {"nees_before", calibration->neesBefore},
                             {"nees_after", calibration->neesAfter}};
    writeFileAtomically(options.out / "calibration.yaml", toYaml(*calibration, options.odometry));
}

}  // namespace

ReplayReport runReplay(const ReplayOptions& options, const std::atomic<bool>& interrupted) {
    checkOptions(options);
    const Stopwatch watch;
    const RecordingOptions& given = options;
    RecordingOptions asked = given;
    asked.needsDepth = options.odometry;
    const ReplaySource source = openReplaySource(asked);
    if (options.odometry && source.frames.size() < 2) {
        throw InputError(options.dataset, "", "a single frame: odometry needs two or more");
    }
    const TrackingMap map =
        options.mapFile.empty() ? TrackingMap{} : loadTrackingMap(options.mapFile);
    const ReplayTracker tracker = makeTracker(options, source, map);
    const std::optional<double> depth = checkDepths(options, source);
    const NoEmptyFolder noEmptyFolder(options.out);
    claimFolder(options.out, {options.dataset, options.cameraFile, options.mapFile});
    for (const char* stale :
         {"result.json", "strips.png", "top_view.png", "groundtruth.tum", "calibration.yaml"}) {
        fs::remove(options.out / stale);
    }

    ReplayRun run = replay(source, tracker, interrupted, [&](std::size_t done) {
        if (options.progress) options.progress(done, source.frames.size());
    });
    if (options.odometry) layOnTruth(run);
    const ReplayErrors errors = judge(run, options.odometry);

    ReplayReport report;
    report.exitCode = run.interrupted ? kInterrupted : isLostForGood(run) ? kNoAnswer : kDone;
    json& result = report.result;
    result = replayResult(source, run, errors, options.odometry);
    result["schema"] = 1;
    result["command"] = "replay";
    result["version"] = PHOTONAV_VERSION;
    result["interrupted"] = run.interrupted;
    result["options"] = optionsJson(options, source, tracker);
    result["dataset"] = datasetJson(options, source, depth);
    result["time"] = {{"total_s", watch.seconds()},
                      {"load_images_s", run.loadSeconds},
                      {"track_s", run.trackSeconds}};
    if (options.calibrate)
        calibrateReplay(options, run, tracker.scale, map.octree != nullptr, result);
    report.summary = replaySummary(result);
    writeReplayTables(options.out, run, errors);
    writeReplayReport(options, toYaml(options, source, tracker), result, source, run, errors,
                      map.describe);
    writeFileAtomically(options.out / "result.json", result.dump(2) + "\n");
    return report;
}

}  // namespace photonav
