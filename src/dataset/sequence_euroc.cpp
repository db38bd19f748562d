// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/sequence_euroc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dataset/image_file.hpp"
#include "dataset/time_order.hpp"
#include "dataset/trajectory.hpp"
#include "io/reading.hpp"
#include "io/text_table.hpp"
#include "io/yaml_reader.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

constexpr double kNanosecond = 1e-9;
constexpr double kFarthestSensor = 1e3;  // from the body [m]

fs::path mavFolder(const std::string& folder) {
    const fs::path inside = fs::path(folder) / "mav0";
    return fs::is_directory(inside) ? inside : fs::path(folder);
}

/// The nearest rotation to what a file gives with a few digits.
Pose rigidPose(const YamlMap& yaml, const std::vector<double>& rows) {
    const Eigen::Matrix4d T =
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
    const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
    const bool isRotation =
        (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-2 && R.determinant() > 0.;
    const bool isNear = T.topRightCorner<3, 1>().cwiseAbs().maxCoeff() <= kFarthestSensor;
    if (!isRotation || !isNear || T.row(3) != Eigen::RowVector4d(0., 0., 0., 1.)) {
        yaml.fail("T_BS.data", "not a rigid motion");
    }
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    pose.translation() = T.topRightCorner<3, 1>();
    return pose;
}

std::vector<double> requiredNumbers(YamlMap& yaml, const std::string& key, std::size_t count) {
    if (!yaml.has(key)) yaml.fail(key, "missing");
    std::vector<double> numbers;
    yaml.readNumbers(key, numbers, count, count);
    return numbers;
}

Pose readMount(YamlMap& sensor) {
    YamlMap T_BS = sensor.map("T_BS");
    return rigidPose(sensor, requiredNumbers(T_BS, "data", 16));
}

DistortedCamera readCamera(const fs::path& folder) {
    const std::string file = (folder / "sensor.yaml").string();
    YamlMap yaml(file, loadYaml(file));
    std::string model;
    std::string distortion;
    yaml.read("camera_model", model);
    yaml.read("distortion_model", distortion);
    if (model != "pinhole") {
        yaml.fail("camera_model", fmt::format("'{}' is not known, only pinhole is", model));
    }
    if (distortion != "radial-tangential") {
        yaml.fail("distortion_model",
                  fmt::format("'{}' is not known, only radial-tangential is", distortion));
    }
    DistortedCamera result;
    result.file = file;
    const auto size = requiredNumbers(yaml, "resolution", 2);
    if (size[0] < 16. || size[1] < 16. || size[0] > 1e5 || size[1] > 1e5) {
        yaml.fail("resolution", "not the size of an image");
    }
    result.camera.width = static_cast<unsigned>(size[0]);
    result.camera.height = static_cast<unsigned>(size[1]);
    const auto k = requiredNumbers(yaml, "intrinsics", 4);
    for (int i = 0; i < 2; ++i) {
        if (!(k[i] >= 0.005 * size[i] && k[i] <= 1e9 && std::abs(k[2 + i]) <= 10. * size[i])) {
            yaml.fail("intrinsics", "not those of a camera");
        }
    }
    result.camera.intrinsics = vpCameraParameters(k[0], k[1], k[2], k[3]);
    const auto d = requiredNumbers(yaml, "distortion_coefficients", 4);
    if (!(Eigen::Map<const Eigen::Vector4d>(d.data()).cwiseAbs().maxCoeff() <= 1e3)) {
        yaml.fail("distortion_coefficients", "not those of a lens");
    }
    result.distortion = Eigen::Map<const Eigen::Vector4d>(d.data());
    result.T_b_c = readMount(yaml);
    return result;
}

void checkSameSize(const DistortedCamera& left, const DistortedCamera& right) {
    const Camera& l = left.camera;
    const Camera& r = right.camera;
    if (l.width == r.width && l.height == r.height) return;
    throw InputError(
        right.file, "resolution",
        fmt::format("{}x{}, but that of cam0 is {}x{}", r.width, r.height, l.width, l.height));
}

std::vector<StampedFile> readImageList(const fs::path& folder, StereoSequence& sequence) {
    const std::string file = (folder / "data.csv").string();
    std::vector<InputError> badRows;
    auto list = parseInOrderOfTime<StampedFile>(
        readCsv(file, 2, &badRows),
        [&](const TextRow& row) {
            return StampedFile{row.time(0, kNanosecond), (folder / "data" / row.text(1)).string()};
        },
        Repeats::skipped, &badRows);
    for (const InputError& row : badRows) sequence.skipped.push_back({file, row.reason()});
    if (list.empty()) throw InputError(file, "", "no images");
    return list;
}

void pairImages(const std::vector<StampedFile>& left, const std::vector<StampedFile>& right,
                double tolerance, StereoSequence& sequence) {
    auto partner = right.begin();
    for (const auto& [timestamp, file] : left) {
        while (partner != right.end() && partner->timestamp < timestamp - tolerance) ++partner;
        if (partner != right.end() && partner->timestamp <= timestamp + tolerance) {
            sequence.frames.push_back({timestamp, Pose::Identity(), false, file, partner->file});
            ++partner;
        } else {
            sequence.skipped.push_back(
                {file, fmt::format("no image of cam1 within {} s", tolerance)});
        }
    }
}

/// T_s_c: from the left camera to the frame whose poses are recorded.
Pose groundtruthFrame(const fs::path& folder, StereoSequence& sequence) {
    sequence.groundtruthOf = "body";
    const std::string file = (folder / "sensor.yaml").string();
    if (!fs::exists(file)) return sequence.left.T_b_c;
    YamlMap yaml(file, loadYaml(file));
    if (yaml.has("T_BS")) return readMount(yaml).inverse() * sequence.left.T_b_c;
    std::string comment;
    yaml.read("comment", comment);
    if (comment.find("cam0") == std::string::npos) return sequence.left.T_b_c;
    sequence.groundtruthOf = "cam0";
    return Pose::Identity();
}

StampedPose parseGroundtruth(const TextRow& row) {
    return poseOfRow(row, row.time(0, kNanosecond), {row.number(1), row.number(2), row.number(3)},
                     {row.number(4), row.number(5), row.number(6), row.number(7)});
}

void addPoses(const fs::path& folder, const EurocOptions& options, StereoSequence& sequence) {
    const std::string file = (folder / "data.csv").string();
    if (!fs::exists(file)) return;
    std::vector<InputError> badRows;
    const Trajectory trajectory =
        trajectoryOf(file, readCsv(file, 8, &badRows), parseGroundtruth, &badRows);
    for (const InputError& row : badRows) sequence.skipped.push_back({file, row.reason()});
    const Pose T_s_c = groundtruthFrame(folder, sequence);
    bool anyPose = false;
    for (auto& frame : sequence.frames) {
        const auto T_w_s =
            poseAt(trajectory, frame.timestamp, options.tolerance, options.maxPoseGap);
        if (!T_w_s) continue;
        anyPose = frame.hasPose = true;
        frame.T_c_w = (*T_w_s * T_s_c).inverse();
    }
    if (anyPose) return;
    throw noPoseNear(file, trajectory, options.tolerance, sequence.frames.front().timestamp,
                     sequence.frames.back().timestamp);
}

StereoSequence readEurocTables(const std::string& folder, const EurocOptions& options) {
    if (!fs::is_directory(folder)) throw InputError(folder, "", "no such folder");
    const fs::path mav = mavFolder(folder);
    for (const char* camera : {"cam0", "cam1"}) {
        if (fs::is_directory(mav / camera)) continue;
        throw InputError((mav / camera).string(), "",
                         "no such folder: a stereo recording has cam0 and cam1");
    }
    StereoSequence sequence;
    sequence.left = readCamera(mav / "cam0");
    sequence.right = readCamera(mav / "cam1");
    checkSameSize(sequence.left, sequence.right);
    const auto left = readImageList(mav / "cam0", sequence);
    sequence.recorded = left.size() + sequence.skipped.size();
    const auto right = readImageList(mav / "cam1", sequence);
    pairImages(left, right, options.stereoTolerance, sequence);
    if (sequence.frames.empty()) {
        throw InputError(
            (mav / "cam1" / "data.csv").string(), "",
            fmt::format("no image within {} s of any image of cam0", options.stereoTolerance));
    }
    addPoses(mav / "state_groundtruth_estimate0", options, sequence);
    return sequence;
}

}  // namespace

bool isEurocFolder(const std::string& folder) {
    return fs::is_directory(fs::path(folder) / "mav0") ||
           fs::is_directory(fs::path(folder) / "cam0");
}

StereoSequence readEurocSequence(const std::string& folder, const EurocOptions& options) {
    return reading(folder, [&] { return readEurocTables(folder, options); });
}

StereoImages loadStereo(const StereoSequence& sequence, std::size_t index) {
    const StereoSequence::Entry& entry = sequence.frames.at(index);
    const auto read = [](const std::string& file, const DistortedCamera& camera) {
        return readGrey8(file, camera.camera, camera.file + " (resolution)");
    };
    return {read(entry.leftFile, sequence.left), read(entry.rightFile, sequence.right)};
}

}  // namespace photonav
