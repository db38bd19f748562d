// SPDX-License-Identifier: BSD-3-Clause
#include "recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "dataset/colmap_model.hpp"
#include "dataset/floor_plane.hpp"
#include "dataset/sequence_euroc.hpp"
#include "dataset/sequence_tum.hpp"
#include "dataset/trajectory.hpp"
#include "evaluation/averages.hpp"
#include "io/error.hpp"
#include "io/number.hpp"
#include "recording/bag_recording.hpp"
#include "recording/stereo_recording.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFloorFrames = 30;
constexpr unsigned kFloorColumns = 32;

/// What the depth images show below the camera, from frames spread over the recording.
struct Seen {
    std::vector<Eigen::Vector3d> points;  ///< in the recorded world
    std::vector<double> depths;           ///< of the same
};

Seen pointsBelow(const Recording& recording, const Eigen::Vector3d& roughUp) {
    const Sequence& sequence = recording.sequence;
    const Camera& camera = sequence.camera;
    const unsigned stride = std::max(1U, camera.width / kFloorColumns);
    const std::size_t step = 1 + (sequence.frames.size() - 1) / kFloorFrames;
    Seen seen;
    for (std::size_t i = 0; i < sequence.frames.size(); i += step) {
        if (!sequence.frames[i].hasPose) continue;
        const RecordedFrame frame = recording.load(i);
        const Pose T_w_c = frame.T_c_w.inverse();
        for (unsigned v = stride / 2; v < camera.height; v += stride) {
            for (unsigned u = stride / 2; u < camera.width; u += stride) {
                const double z = frame.view.depth[v][u];
                if (!(z > 0.)) continue;
                const Eigen::Vector3d p = camera.unproject(u, v, z);
                if ((T_w_c.linear() * p).dot(roughUp) > 0.) continue;
                seen.points.push_back(T_w_c * p);
                seen.depths.push_back(z);
            }
        }
    }
    return seen;
}

Eigen::Vector3d upByFloor(const Recording& recording) {
    if (!recording.sequence.hasDepth()) {
        throw InputError("--up", "floor", "the recording has no depth images to find it in");
    }
    if (!recording.sequence.hasPoses()) {
        throw InputError("--up", "", "needs recorded poses, which this recording does not have");
    }
    Eigen::Vector3d roughUp = Eigen::Vector3d::Zero();  // the upper edge of the images
    for (const auto& frame : recording.sequence.frames) {
        if (!frame.hasPose) continue;
        roughUp -= frame.T_c_w.linear().row(1).transpose();
    }
    const Seen seen = pointsBelow(recording, roughUp.normalized());
    std::optional<Eigen::Vector3d> up;
    if (!seen.points.empty() && roughUp.norm() > 1e-9) {
        FloorOptions options;
        options.tolerance = 0.01 * median(seen.depths, 0.);
        up = floorNormal(seen.points, roughUp.normalized(), options);
    }
    if (!up) {
        throw InputError("--up", "floor",
                         "no floor to be seen toward the lower edge of the images; of a camera "
                         "that looks straight down give the direction x,y,z");
    }
    return *up;
}

void checkDepthImages(const RecordingOptions& options) {
    const fs::path folder = options.dataset;
    if (!options.needsDepth || !fs::exists(folder / "rgb.txt")) return;
    for (const char* list : {"depth.txt", "assoc.txt", "associations.txt"}) {
        if (fs::exists(folder / list)) return;
    }
    throw InputError((folder / "depth.txt").string(), "",
                     "no such file; without depth images there is `map --depth monocular`, and "
                     "`replay --map`");
}

void checkReading(const RecordingOptions& options) {
    const auto require = [](bool good, const char* option, const std::string& reason) {
        if (!good) throw InputError(option, "", reason);
    };
    require(options.every >= 1, "--every", "must be at least 1");
    const auto isPositive = [](double x) { return std::isfinite(x) && x > 0.; };
    require(isPositive(options.tolerance), "--tolerance", "must be above 0");
    require(isPositive(options.depthScale.value_or(1.)), "--depth-scale", "must be above 0");
    require(parseUp(options.up) || options.up == "floor", "--up",
            fmt::format("'{}' is not one of {}, nor x,y,z, nor floor", options.up,
                        fmt::join(axisNames(), ", ")));
    require(options.stereo.empty() || options.stereo == "bm" || options.stereo == "sgbm",
            "--stereo", fmt::format("'{}' is not one of bm, sgbm", options.stereo));
}

/// All frames of a dataset with depth images, in the recorded world.
Recording readDepthRecording(const RecordingOptions& options) {
    if (!options.stereo.empty()) {
        throw InputError("--stereo", "", "is for EuRoC recordings: this one has depth images");
    }
    checkDepthImages(options);
    TumOptions tum;
    tum.tolerance = options.tolerance;
    tum.depthScale = options.depthScale;
    tum.cameraFile = options.cameraFile;
    tum.forgiving = options.forgiving;
    tum.needsDepth = options.needsDepth;
    Recording recording;
    recording.layout = "TUM RGB-D";
    recording.sequence = readTumSequence(options.dataset, tum);
    if (recording.sequence.cameraAssumed) recording.note = "the benchmark's Kinect was assumed";
    if (options.depthScale && !recording.sequence.hasDepth()) {
        throw InputError("--depth-scale", "", "the recording has no depth images");
    }
    recording.view = [all = recording.sequence, isStopped = options.isStopped](std::size_t i) {
        return loadFrame(all, i, isStopped).view;
    };
    return recording;
}

/// The images of a COLMAP model, without depth.
Recording readColmapRecording(const RecordingOptions& options) {
    const auto refuse = [](const char* option) {
        throw InputError(option, "", "does not apply to a COLMAP model");
    };
    if (!options.stereo.empty()) refuse("--stereo");
    if (options.depthScale) refuse("--depth-scale");
    if (!options.cameraFile.empty()) refuse("--camera");
    if (options.needsDepth) {
        throw InputError(options.dataset, "",
                         "a COLMAP model has no depth images; without them there is `map --depth "
                         "monocular`, and `replay --map`");
    }
    Recording recording;
    recording.layout = "COLMAP";
    recording.sequence = readColmapSequence(options.dataset);
    recording.note = "without times: the images are taken a second apart";
    recording.view = [all = recording.sequence](std::size_t i) { return loadFrame(all, i).view; };
    return recording;
}

void refuseOptionsOfBags(const RecordingOptions& options) {
    const auto refuse = [](bool isGiven, const char* option) {
        if (isGiven) throw InputError(option, "", "is for ROS bags");
    };
    refuse(!options.topics.empty(), "--topics");
    refuse(!options.mount.empty(), "--mount");
}

Recording readLayout(const RecordingOptions& options) {
    if (isBagRecording(options.dataset)) return readBagRecording(options);
    refuseOptionsOfBags(options);
    if (isEurocFolder(options.dataset)) return readStereoRecording(options);
    const bool isTum = fs::exists(fs::path(options.dataset) / "rgb.txt");
    if (!isTum && isColmapFolder(options.dataset)) return readColmapRecording(options);
    return readDepthRecording(options);
}

/// Only these frames, with their images.
void keepFrames(Recording& recording, const std::vector<std::size_t>& indices) {
    std::vector<Sequence::Entry> kept;
    kept.reserve(indices.size());
    for (const std::size_t i : indices) kept.push_back(recording.sequence.frames[i]);
    recording.sequence.frames = std::move(kept);
    recording.view = [all = recording.view, indices](std::size_t i) { return all(indices.at(i)); };
}

void skipWithoutPose(const RecordingOptions& options, Recording& recording) {
    std::vector<std::size_t> posed;
    const auto& frames = recording.sequence.frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (frames[i].hasPose) {
            posed.push_back(i);
        } else {
            recording.sequence.skipped.push_back(
                {frames[i].colourFile, fmt::format("no pose within {} s", options.tolerance)});
        }
    }
    if (posed.empty()) throw InputError(options.dataset, "", "no poses of the camera");
    keepFrames(recording, posed);
}

}  // namespace

void requirePlausibleDepth(double median, const RecordingOptions& options,
                           const std::string& cameraFile) {
    constexpr double kLeast = 0.05, kMost = 100., kUsual = 2.;  // [m]
    if (median >= kLeast && median <= kMost) return;
    const bool isOfFile = !options.depthScale && !cameraFile.empty();
    throw InputError(isOfFile ? cameraFile : options.dataset,
                     isOfFile ? "depth_scale" : "--depth-scale",
                     fmt::format("implausible depths: their median is {:.3g} m; the scale seems "
                                 "{} by a factor of about {:.0e}",
                                 median, median > 1. ? "too small" : "too large",
                                 std::max(median / kUsual, kUsual / median)));
}

Pose parsePose(const std::string& text, const char* option) {
    const auto numbers = numbersIn(text, ',');
    if (!numbers || numbers->size() != 7) {
        throw InputError(option, "", fmt::format("'{}' is not x,y,z,qx,qy,qz,qw", text));
    }
    const Eigen::Map<const Eigen::Matrix<double, 7, 1>> v(numbers->data());
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (!(std::abs(q.norm() - 1.) <= 0.1)) {
        throw InputError(option, "",
                         fmt::format("'{}' is not x,y,z,qx,qy,qz,qw with a unit quaternion", text));
    }
    Pose pose = Pose::Identity();
    pose.linear() = q.normalized().toRotationMatrix();
    pose.translation() = v.head<3>();
    return pose;
}

std::optional<Eigen::Vector3d> parseUp(const std::string& text) {
    const auto& axes = axisNames();
    if (std::find(axes.begin(), axes.end(), text) != axes.end()) {
        return worldUpRotation(text).transpose() * Eigen::Vector3d::UnitZ();
    }
    const auto numbers = numbersIn(text, ',');
    if (!numbers || numbers->size() != 3) return {};
    const Eigen::Vector3d up(numbers->data());
    if (!(up.cwiseAbs().maxCoeff() > 1e-9)) return {};
    return up.stableNormalized();
}

std::pair<std::size_t, std::size_t> parseFrames(const std::string& text, std::size_t count) {
    if (text.empty()) return {0, count};
    const auto colon = text.find(':');
    const std::string before = text.substr(0, colon);
    const std::string after = colon == std::string::npos ? "" : text.substr(colon + 1);
    const auto first = before.empty() ? 0 : numberIn<std::size_t>(before);
    const auto end = after.empty() ? count : numberIn<std::size_t>(after);
    if (colon == std::string::npos || !first || !end) {
        throw InputError("--frames", "", fmt::format("'{}' is not a range first:end", text));
    }
    if (*first >= std::min(*end, count)) {
        throw InputError("--frames", "", fmt::format("'{}' leaves none of {} frames", text, count));
    }
    return {*first, std::min(*end, count)};
}

Recording readRecording(const RecordingOptions& options) {
    checkReading(options);
    Recording recording = readLayout(options);
    if (!options.forgiving) skipWithoutPose(options, recording);
    const auto given = parseUp(options.up);
    recording.up = given ? *given : upByFloor(recording);
    Pose T_recorded_w = Pose::Identity();
    T_recorded_w.linear() = worldUpRotation(recording.up).transpose();
    auto& frames = recording.sequence.frames;
    const auto [first, end] = parseFrames(options.frames, frames.size());
    std::vector<std::size_t> used;
    for (std::size_t i = first; i < end; i += std::size_t(options.every)) used.push_back(i);
    keepFrames(recording, used);
    for (Sequence::Entry& frame : frames) {
        if (frame.hasPose) frame.T_c_w = frame.T_c_w * T_recorded_w;
    }
    return recording;
}

std::string upText(const Eigen::Vector3d& up) {
    for (const std::string& name : axisNames()) {
        if (up == *parseUp(name)) return name;
    }
    return fmt::format("{:.17g},{:.17g},{:.17g}", up.x(), up.y(), up.z());
}

double tiltDegrees(const Eigen::Vector3d& up) {
    return std::acos(std::min(1., up.cwiseAbs().maxCoeff())) * 180. / std::numbers::pi;
}

}  // namespace photonav
