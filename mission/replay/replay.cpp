// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "dataset/trajectory.hpp"
#include "estimation/calibration.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "io/error.hpp"
#include "io/number.hpp"
#include "mapping/map_config.hpp"
#include "render/interruptible_views.hpp"
#include "replay/calibration_file.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

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
    const auto isSigma = [](const std::optional<double>& x) {
        return !x || (std::isfinite(*x) && *x >= 0.);
    };
    require(isSigma(options.leastSigma), "--least-sigma", "must be a number, not negative");
    require(isSigma(options.leastSigmaRotation), "--least-sigma-rotation",
            "must be a number, not negative");
    require(options.minOverlap > 0. && options.minOverlap < 1., "--min-overlap",
            "must be between 0 and 1");
    require(options.maxWidth.value_or(kWidthInMap) >= kLeastWidth, "--max-width",
            fmt::format("must be at least {}", kLeastWidth));
}

/// Scale and least sigmas that the options leave open.
void applyCalibration(std::optional<MapKind> map, ReplayOptions& options) {
    const Calibration calibration = readCalibration(options.calibration, map);
    options.scale = options.scale.value_or(calibration.scale);
    options.leastSigma = options.leastSigma.value_or(calibration.leastSigma);
    options.leastSigmaRotation =
        options.leastSigmaRotation.value_or(calibration.leastSigmaRotation);
}

/// The upward direction (--up) with which a map was made, read from the config.yaml beside it. The
/// floor is not fitted again: the result would differ, and rotate the recording relative to the
/// map.
std::string upOfMap(const std::string& mapFile) {
    if (const auto map = optionsOfMap(mapFile)) return map->up;
    const auto config = fs::path(mapFile).parent_path() / "config.yaml";
    throw InputError("--up", "floor",
                     fmt::format("the map's own is taken, but there is no {} of a recorded map; "
                                 "give an axis or x,y,z",
                                 config.string()));
}

Recording openRecording(const ReplayOptions& options) {
    const RecordingOptions& given = options;
    RecordingOptions reading = given;
    if (options.up == "floor" && !options.odometry) reading.up = upOfMap(options.mapFile);
    reading.forgiving = true;
    reading.needsDepth = options.odometry;
    Recording recording = readRecording(reading);
    if (options.up != "z" && !recording.sequence.hasPoses()) {
        throw InputError("--up", "", "needs recorded poses, which this recording does not have");
    }
    if (options.odometry && recording.sequence.frames.size() < 2) {
        throw InputError(options.dataset, "", "a single frame: odometry needs two or more");
    }
    return recording;
}

/// T_c_w of the images that `photonav map` made a map of, which it writes beside it; else none.
Trajectory makersOf(const std::string& mapFile) {
    const fs::path map(mapFile);
    const fs::path file = map.parent_path() / "trajectory.tum";
    if (map.extension() != ".ot" || !fs::exists(file)) return {};
    return readTrajectory(file.string());
}

/// How far a map of depth that does not fit its images is displaced where an image shows it: what
/// the sensor gets wrong is a share of the motion between two images (`depth_error`), here since
/// the nearest of those that the map was made of. Images of a tracker agree with the map, so that
/// the pose in the world is uncertain by this much more.
Matrix6 displacementOfMap(double share, const Trajectory& makers, const Pose& T_c_w,
                          double meanDepth) {
    Vector6 least = Vector6::Constant(kInfinity);
    const auto motionOfImage = [&](const Vector6& xi) {  // [rad]
        return xi.head<3>().norm() / meanDepth + xi.tail<3>().norm();
    };
    for (const StampedPose& maker : makers) {
        const Vector6 xi = logSE3(T_c_w * maker.T_w_c);
        if (motionOfImage(xi) < motionOfImage(least)) least = xi;
    }
    Vector6 variance;
    variance << Eigen::Vector3d::Constant(least.head<3>().squaredNorm()),
        Eigen::Vector3d::Constant(least.tail<3>().squaredNorm());
    return (share * share * variance).asDiagonal();
}

ReplayTracker inDisplacedMap(ReplayTracker tracker, double share, const Trajectory& makers) {
    tracker.track = [=, track = tracker.track](const View& view, double timestamp) {
        TrackedFrame frame = track(view, timestamp);
        frame.T_c_w.covariance +=
            displacementOfMap(share, makers, frame.T_c_w.mean, frame.alignment.meanDepth);
        return frame;
    };
    return tracker;
}

/// Belief of the first frame's T_c_w.
UncertainPose startOf(const ReplayOptions& options, const Sequence& sequence) {
    UncertainPose start;
    if (options.startSigma) {
        start.covariance = *options.startSigma * *options.startSigma * Matrix6::Identity();
    }
    if (!options.start.empty()) {
        start.mean = parsePose(options.start, "--start").inverse();
        if (options.odometry && sequence.hasPoses()) {
            throw InputError(
                "--start", "",
                "not with --odometry of a recording with ground truth: it begins at the "
                "first true pose");
        }
    } else if (!options.odometry) {
        if (!sequence.frames[0].hasPose) {
            throw InputError(
                options.dataset, "--start",
                sequence.hasPoses()
                    ? "needed: the first frame has no true pose (or begin later with --frames)"
                    : "needed: the recording has no ground truth to begin from");
        }
        start.mean = sequence.frames[0].T_c_w;
    }
    return start;
}

AlignmentOptions alignmentOf(const ReplayOptions& options, const Sequence& sequence,
                             const TrackingMap& map, const DepthError& depthError) {
    AlignmentOptions alignment;
    if (options.odometry) {
        alignment = KeyframeOptions().alignment;
        alignment.modelErrors.depthScale = depthError.relative;
    } else {
        alignment = realCameraOptions(sequence.blur.value_or(kAreaBlur));
        alignment.modelErrors.surface = map.surfaceError();
        alignment.cellSize = map.resolution();
        // The motion is only guessed: in directions that are almost noise the pose follows the
        // image all the same, or it would drift.
        if (map.kind != MapKind::mesh) alignment.modelNoise = ModelNoise::inCovariance;
        // Nothing but the image stops a pose from sliding away.
        alignment.trust.maxUnexplained = 0.25;
        if (sequence.informationScale) alignment.photometric.scale = *sequence.informationScale;
    }
    alignment.photometric.sigma = options.sigma;
    if (!options.exposure) {
        alignment.exposure.reset();
    } else if (!alignment.exposure) {
        alignment.exposure.emplace();
    }
    alignment.robust = RobustWeight::huber;
    alignment.trust.minOverlap = options.minOverlap;
    alignment.informationScale = options.scale.value_or(1.);
    if (options.leastSigma) alignment.trust.leastSigma = *options.leastSigma;
    if (options.leastSigmaRotation)
        alignment.trust.leastSigmaRotation = *options.leastSigmaRotation;
    return alignment;
}

void setWidth(KeyframeOptions& keyframe, const Camera& camera, int maxWidth) {
    keyframe.finest = 0;
    while (static_cast<int>(camera.width >> keyframe.finest) > maxWidth) ++keyframe.finest;
    // Of all pixels only those with a gradient: faster, and as accurate
    // (docs/experiments/replays.md).
    if (keyframe.finest == 0) keyframe.minGradient = 0.02;
}

std::optional<double> checkDepths(const ReplayOptions& options, const Recording& recording,
                                  const std::optional<double>& depth) {
    if (!depth) return {};
    if (*depth > 0.) {
        requirePlausibleDepth(*depth, options, recording.sequence.cameraFile);
        return depth;
    }
    // Black images have no depth from stereo, and replaying them says what they are.
    if (options.odometry && recording.stereo.empty()) {
        throw InputError(options.dataset, "", "no depth in any of the images looked at");
    }
    return {};
}

}  // namespace

Replay::Replay(const ReplayOptions& options) : options_(options) {
    checkOptions(options_);
    recording_ = openRecording(options_);
    if (!options_.odometry) {
        map_ = loadTrackingMap(options_.mapFile);
        options_.startSigma = options_.startSigma.value_or(kStartSigma);
        makers_ = makersOf(options_.mapFile);
    }
    if (!options_.calibration.empty()) {
        applyCalibration(options_.odometry ? std::nullopt : std::optional(map_.kind), options_);
    }
    start_ = startOf(options_, recording_.sequence);
    const DepthLook look = lookAtDepth(recording_);
    medianDepth_ = checkDepths(options, recording_, look.median);
    depthNoise_ = look.noise.atOneMetre();
    if (options_.odometry || !makers_.empty()) {
        depthError_ = depthErrorOf(recording_, look.noise);
    }
    alignment_ = alignmentOf(options_, recording_.sequence, map_, depthError_);
    options_.stereo = recording_.stereo;
    options_.scale = alignment_.informationScale;
    options_.leastSigma = alignment_.trust.leastSigma;
    options_.leastSigmaRotation = alignment_.trust.leastSigmaRotation;
}

ReplayTracker Replay::makeTracker(const IsStopped& isStopped) const {
    const Camera& camera = recording_.sequence.camera;
    if (options_.odometry) {
        KeyframeChainOptions odometry;
        odometry.keyframe.alignment = alignment_;
        if (options_.maxWidth) setWidth(odometry.keyframe, camera, *options_.maxWidth);
        return odometryTracker(camera, start_, odometry);
    }
    TrackerOptions tracker;
    tracker.map = alignment_;
    std::shared_ptr<const ViewSource> views = map_.views;
    if (isStopped) views = std::make_shared<InterruptibleViews>(views, isStopped);
    ReplayTracker inMap =
        mapTracker(views, camera, start_, tracker,
                   static_cast<unsigned>(options_.maxWidth.value_or(kWidthInMap)));
    const double share = depthError_.relative;
    return share > 0. ? inDisplacedMap(inMap, share, makers_) : inMap;
}

ReplayRun Replay::run(const IsStopped& isStopped,
                      const std::function<void(std::size_t)>& progress) const {
    ReplayRun run = replay(recording_, makeTracker(isStopped), isStopped, progress);
    if (options_.odometry) alignToTruth(run);
    run.truthCovariance.diagonal().head<3>().setConstant(std::pow(options_.truthSigma, 2));
    run.truthCovariance.diagonal().tail<3>().setConstant(std::pow(options_.truthSigmaRotation, 2));
    return run;
}

}  // namespace photonav
