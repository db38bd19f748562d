// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/sequence_tum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "dataset/association.hpp"
#include "dataset/camera_file.hpp"
#include "dataset/image_file.hpp"
#include "dataset/time_order.hpp"
#include "dataset/trajectory.hpp"
#include "io/reading.hpp"
#include "io/text_table.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

struct Pair {
    double timestamp = 0.;  ///< of the colour image [s]
    std::string colour;
    StampedFile depth;
};

/// Rows that cannot be used are skipped where that is asked for.
template <typename Item>
std::vector<Item> readList(const std::string& file, std::size_t columns,
                           const std::function<Item(const TextRow&)>& parse, bool forgiving,
                           Sequence& sequence) {
    std::vector<InputError> badRows;
    std::vector<InputError>* bad = forgiving ? &badRows : nullptr;
    auto list = parseInOrderOfTime(readTable(file, columns, bad), parse, Repeats::skipped, bad);
    for (const InputError& row : badRows) sequence.skipped.push_back({file, row.reason()});
    if (list.empty()) throw InputError(file, "", "no images");
    return list;
}

std::vector<StampedFile> readFileList(const fs::path& folder, const std::string& name,
                                      bool forgiving, Sequence& sequence) {
    return readList<StampedFile>(
        (folder / name).string(), 2,
        [&](const TextRow& row) {
            return StampedFile{row.time(0), (folder / row.text(1)).string()};
        },
        forgiving, sequence);
}

std::vector<Pair> readAssociation(const fs::path& folder, const std::string& name, bool forgiving,
                                  Sequence& sequence) {
    return readList<Pair>((folder / name).string(), 4,
                          [&](const TextRow& row) {
                              StampedFile colour{row.time(0), (folder / row.text(1)).string()};
                              StampedFile depth{row.time(2), (folder / row.text(3)).string()};
                              if (row.text(1).starts_with("depth")) std::swap(colour, depth);
                              return Pair{colour.timestamp, colour.file, depth};
                          },
                          forgiving, sequence);
}

std::vector<double> timesOf(const std::vector<StampedFile>& files) {
    std::vector<double> times;
    times.reserve(files.size());
    for (const StampedFile& file : files) times.push_back(file.timestamp);
    return times;
}

std::vector<Pair> readPairs(const fs::path& folder, const TumOptions& options, Sequence& sequence) {
    const double tolerance = options.tolerance;
    for (const char* name : {"assoc.txt", "associations.txt"}) {
        if (!fs::exists(folder / name)) continue;
        auto pairs = readAssociation(folder, name, options.forgiving, sequence);
        sequence.recorded = pairs.size() + sequence.skipped.size();
        return pairs;
    }
    const auto colour = readFileList(folder, "rgb.txt", options.forgiving, sequence);
    sequence.recorded = colour.size() + sequence.skipped.size();
    std::vector<StampedFile> depth;
    if (options.needsDepth || fs::exists(folder / "depth.txt")) {
        depth = readFileList(folder, "depth.txt", options.forgiving, sequence);
    }
    const auto partner = associate(timesOf(colour), timesOf(depth), tolerance);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < colour.size(); ++i) {
        if (partner[i] >= 0) {
            pairs.push_back({colour[i].timestamp, colour[i].file, depth[partner[i]]});
        } else if (!options.needsDepth) {
            pairs.push_back({colour[i].timestamp, colour[i].file, {}});
        } else {
            sequence.skipped.push_back(
                {colour[i].file, fmt::format("no depth image within {} s", tolerance)});
        }
    }
    if (pairs.empty()) {
        throw InputError((folder / "depth.txt").string(), "",
                         fmt::format("no depth image within {} s of any colour image", tolerance));
    }
    return pairs;
}

void forgetMissingDepth(std::vector<Pair>& pairs) {
    for (Pair& pair : pairs) {
        if (!fs::exists(pair.depth.file)) pair.depth.file.clear();
    }
}

void addPoses(const std::string& groundtruth, const std::vector<Pair>& pairs,
              const TumOptions& options, Sequence& sequence) {
    Trajectory trajectory;
    std::vector<InputError> badRows;
    if (!options.forgiving || fs::exists(groundtruth)) {
        trajectory = readTrajectory(groundtruth, options.forgiving ? &badRows : nullptr);
    }
    for (const InputError& row : badRows) sequence.skipped.push_back({groundtruth, row.reason()});
    const auto& depthCamera = sequence.depthCamera;
    const Pose T_colour_posed =
        depthCamera && depthCamera->hasPoses ? depthCamera->T_c_d : Pose::Identity();
    bool anyPose = false;
    for (const auto& [timestamp, colour, depth] : pairs) {
        const auto T_w_c = poseAt(trajectory, timestamp, options.tolerance, options.maxPoseGap);
        anyPose = anyPose || T_w_c;
        if (T_w_c || options.forgiving) {
            sequence.frames.push_back({timestamp,
                                       T_w_c ? T_colour_posed * T_w_c->inverse() : Pose::Identity(),
                                       T_w_c.has_value(), colour, depth.file});
        } else {
            sequence.skipped.push_back(
                {colour, fmt::format("no pose within {} s", options.tolerance)});
        }
    }
    if (!anyPose && !trajectory.empty()) {
        throw noPoseNear(groundtruth, trajectory, options.tolerance, pairs.front().timestamp,
                         pairs.back().timestamp);
    }
}

Sequence readTumTables(const std::string& folder, const TumOptions& options) {
    if (!fs::is_directory(folder)) throw InputError(folder, "", "no such folder");
    Sequence sequence;
    const std::string inFolder = (fs::path(folder) / "camera.yaml").string();
    if (!options.cameraFile.empty() || fs::exists(inFolder)) {
        readCameraFile(options.cameraFile.empty() ? inFolder : options.cameraFile, sequence);
    } else {
        sequence.camera = {640, 480, vpCameraParameters(525., 525., 319.5, 239.5)};
        sequence.cameraAssumed = true;
    }
    sequence.needsDepth = options.needsDepth;
    if (options.depthScale) sequence.depthScale = *options.depthScale;
    auto pairs = readPairs(folder, options, sequence);
    if (!options.needsDepth) forgetMissingDepth(pairs);
    addPoses((fs::path(folder) / "groundtruth.txt").string(), pairs, options, sequence);
    return sequence;
}

/// The file and keys that give a camera's size, for messages.
std::string sourceOfSize(const Sequence& sequence, const std::string& keys) {
    if (sequence.cameraAssumed) return "the camera assumed without a camera.yaml";
    return fmt::format("{} ({})", sequence.cameraFile, keys);
}

}  // namespace

Sequence readTumSequence(const std::string& folder, const TumOptions& options) {
    return reading(folder, [&] { return readTumTables(folder, options); });
}

ImageF loadDepth(const Sequence& sequence, std::size_t index) {
    const bool isOther = sequence.depthCamera.has_value();
    const Camera& camera = isOther ? sequence.depthCamera->camera : sequence.camera;
    return readDepth16(
        sequence.frames.at(index).depthFile, camera,
        sourceOfSize(sequence, isOther ? "depth_camera.width, height" : "width, height"),
        1. / sequence.depthScale);
}

RecordedFrame loadFrame(const Sequence& sequence, std::size_t index, const IsStopped& isStopped) {
    const Sequence::Entry& entry = sequence.frames.at(index);
    const Camera& camera = sequence.camera;
    const vpImage<unsigned char> grey =
        readGrey8(entry.colourFile, camera, sourceOfSize(sequence, "width, height"));
    RecordedFrame frame{entry.T_c_w, {}, entry.timestamp};
    frame.view.intensity.resize(camera.height, camera.width);
    for (unsigned i = 0; i < grey.getSize(); ++i) {
        frame.view.intensity.bitmap[i] = static_cast<float>(grey.bitmap[i]) / 255.F;
    }
    throwIfStopped(isStopped);
    try {
        if (!entry.depthFile.empty()) frame.view.depth = loadDepth(sequence, index);
    } catch (const InputError&) {
        if (sequence.needsDepth) throw;
    }
    if (frame.view.depth.getSize() == 0) {
        frame.view.depth.resize(camera.height, camera.width, 0.F);
    } else if (sequence.depthCamera) {
        frame.view.depth = registeredDepth(frame.view.depth, *sequence.depthCamera, camera);
    }
    return frame;
}

}  // namespace photonav
