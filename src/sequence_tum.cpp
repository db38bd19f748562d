// SPDX-License-Identifier: BSD-3-Clause
#include "sequence_tum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "image_bytes.hpp"
#include "text_table.hpp"
#include "trajectory.hpp"
#include "yaml_reader.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

struct StampedFile {
    double timestamp;
    std::string file;
};

struct Pair {
    StampedFile colour;
    StampedFile depth;
};

std::vector<StampedFile> readFileList(const fs::path& folder, const std::string& name) {
    std::vector<StampedFile> list;
    for (const TextRow& row : readTable((folder / name).string(), 2)) {
        list.push_back({row.number(0), (folder / row.text(1)).string()});
        const std::size_t n = list.size();
        if (n > 1 && list[n - 1].timestamp < list[n - 2].timestamp) {
            row.fail("timestamp is smaller than the one before");
        }
    }
    if (list.empty()) throw InputError((folder / name).string(), "", "no images");
    return list;
}

std::vector<Pair> readAssociation(const fs::path& folder, const std::string& name) {
    std::vector<Pair> pairs;
    for (const TextRow& row : readTable((folder / name).string(), 4)) {
        Pair pair{{row.number(0), (folder / row.text(1)).string()},
                  {row.number(2), (folder / row.text(3)).string()}};
        if (row.text(1).starts_with("depth")) std::swap(pair.colour, pair.depth);
        if (!pairs.empty() && pair.colour.timestamp < pairs.back().colour.timestamp) {
            row.fail("timestamp is smaller than the one before");
        }
        pairs.push_back(std::move(pair));
    }
    if (pairs.empty()) throw InputError((folder / name).string(), "", "no images");
    return pairs;
}

/// Index of the depth image of every colour image, or -1: closest pairs first, as the benchmark's
/// associate.py.
std::vector<int> associate(const std::vector<StampedFile>& colour,
                           const std::vector<StampedFile>& depth, double tolerance) {
    struct Candidate {
        double difference;
        int colour;
        int depth;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < colour.size(); ++i) {
        const double time = colour[i].timestamp;
        auto j =
            std::lower_bound(depth.begin(), depth.end(), time - tolerance,
                             [](const StampedFile& file, double t) { return file.timestamp < t; });
        for (; j != depth.end() && j->timestamp <= time + tolerance; ++j) {
            candidates.push_back({std::abs(j->timestamp - time), static_cast<int>(i),
                                  static_cast<int>(j - depth.begin())});
        }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.difference < b.difference; });
    std::vector<int> partner(colour.size(), -1);
    std::vector<bool> taken(depth.size(), false);
    for (const auto& candidate : candidates) {
        if (partner[candidate.colour] >= 0 || taken[candidate.depth]) continue;
        partner[candidate.colour] = candidate.depth;
        taken[candidate.depth] = true;
    }
    return partner;
}

std::vector<Pair> readPairs(const fs::path& folder, double tolerance, Sequence& sequence) {
    for (const char* name : {"assoc.txt", "associations.txt"}) {
        if (fs::exists(folder / name)) return readAssociation(folder, name);
    }
    const auto colour = readFileList(folder, "rgb.txt");
    const auto depth = readFileList(folder, "depth.txt");
    const auto partner = associate(colour, depth, tolerance);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < colour.size(); ++i) {
        if (partner[i] >= 0) {
            pairs.push_back({colour[i], depth[partner[i]]});
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

/// Fields of view up to 179 degrees, principal points up to ten images outside: beyond, a number
/// has gone wrong.
vpCameraParameters readIntrinsics(YamlMap& yaml, const Camera& camera) {
    const auto required = [&](const std::string& key, double least, double most) {
        if (!yaml.has(key)) yaml.fail(key, "missing");
        double value = 0.;
        yaml.readNumber(key, value, least, most);
        return value;
    };
    const double width = camera.width;
    const double height = camera.height;
    return {required("fx", 0.005 * width, 1e9), required("fy", 0.005 * height, 1e9),
            required("cx", -10. * width, 10. * width), required("cy", -10. * height, 10. * height)};
}

void readCamera(const std::string& file, Sequence& sequence) {
    YamlMap yaml(file, loadYaml(file));
    const auto readPixels = [&](const std::string& key, unsigned& value) {
        if (!yaml.has(key)) yaml.fail(key, "missing");
        yaml.read(key, value);
        if (value == 0) yaml.fail(key, "is zero");
    };
    readPixels("width", sequence.camera.width);
    readPixels("height", sequence.camera.height);
    sequence.camera.intrinsics = readIntrinsics(yaml, sequence.camera);
    yaml.readNumber("depth_scale", sequence.depthScale, 1e-6,
                    std::numeric_limits<double>::infinity());
    if (yaml.has("depth_camera")) {
        YamlMap depthCamera = yaml.map("depth_camera");
        sequence.depthIntrinsics = readIntrinsics(depthCamera, sequence.camera);
        depthCamera.finish();
    }
    yaml.finish();
}

cv::Mat readImage(const std::string& file, int flags, const Camera& camera) {
    const auto bytes = soundImage(readBytes(file));
    cv::Mat image = bytes.empty() ? cv::Mat() : cv::imdecode(bytes, flags);
    if (image.empty()) throw InputError(file, "", "not an image, or damaged");
    if (image.cols != int(camera.width) || image.rows != int(camera.height)) {
        throw InputError(file, "",
                         fmt::format("{}x{} pixels, but the camera has {}x{}", image.cols,
                                     image.rows, camera.width, camera.height));
    }
    return image;
}

/// For every colour column (or row) the depth column of the same ray, or -1 outside the image.
std::vector<int> depthPixels(unsigned count, double focal, double centre, double depthFocal,
                             double depthCentre) {
    std::vector<int> pixels(count);
    for (unsigned i = 0; i < count; ++i) {
        const double j = std::round((i - centre) * depthFocal / focal + depthCentre);
        pixels[i] = j >= 0. && j < count ? static_cast<int>(j) : -1;
    }
    return pixels;
}

}  // namespace

Sequence readTumSequence(const std::string& folder, const TumOptions& options) {
    if (!fs::is_directory(folder)) throw InputError(folder, "", "no such folder");
    if (fs::is_empty(folder)) throw InputError(folder, "", "the folder is empty");
    Sequence sequence;
    const std::string inFolder = (fs::path(folder) / "camera.yaml").string();
    if (!options.cameraFile.empty() || fs::exists(inFolder)) {
        readCamera(options.cameraFile.empty() ? inFolder : options.cameraFile, sequence);
    } else {
        sequence.camera = {640, 480, vpCameraParameters(525., 525., 319.5, 239.5)};
        sequence.cameraAssumed = true;
    }
    if (options.depthScale) sequence.depthScale = *options.depthScale;
    const auto pairs = readPairs(folder, options.tolerance, sequence);
    const std::string groundtruth = (fs::path(folder) / "groundtruth.txt").string();
    const Trajectory trajectory = readTrajectory(groundtruth);
    for (const auto& [colour, depth] : pairs) {
        const auto T_w_c =
            poseAt(trajectory, colour.timestamp, options.tolerance, options.maxPoseGap);
        if (T_w_c) {
            sequence.frames.push_back(
                {colour.timestamp, T_w_c->inverse(), colour.file, depth.file});
        } else {
            sequence.skipped.push_back(
                {colour.file, fmt::format("no pose within {} s", options.tolerance)});
        }
    }
    if (sequence.frames.empty()) {
        throw InputError(groundtruth, "",
                         fmt::format("no pose within {} s of any image", options.tolerance));
    }
    return sequence;
}

RecordedFrame loadFrame(const Sequence& sequence, std::size_t index) {
    const Sequence::Entry& entry = sequence.frames.at(index);
    const Camera& camera = sequence.camera;
    const cv::Mat grey =
        readImage(entry.colourFile, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION, camera);
    const cv::Mat depth = readImage(entry.depthFile, cv::IMREAD_UNCHANGED, camera);
    if (depth.type() != CV_16UC1) {
        throw InputError(entry.depthFile, "", "expected one channel of 16 bits");
    }
    RecordedFrame frame{entry.T_c_w, {}, entry.timestamp};
    frame.view.intensity.resize(camera.height, camera.width);
    frame.view.depth.resize(camera.height, camera.width, 0.F);
    const vpCameraParameters& k = camera.intrinsics;
    const vpCameraParameters& d = sequence.depthIntrinsics.value_or(k);
    const auto metres = static_cast<float>(1. / sequence.depthScale);
    const auto depthColumns =
        depthPixels(camera.width, k.get_px(), k.get_u0(), d.get_px(), d.get_u0());
    const auto depthRows =
        depthPixels(camera.height, k.get_py(), k.get_v0(), d.get_py(), d.get_v0());
    for (unsigned v = 0; v < camera.height; ++v) {
        const auto* g = grey.ptr<std::uint8_t>(static_cast<int>(v));
        for (unsigned u = 0; u < camera.width; ++u) {
            frame.view.intensity[v][u] = static_cast<float>(g[u]) / 255.F;
        }
        if (depthRows[v] < 0) continue;
        const auto* z = depth.ptr<std::uint16_t>(depthRows[v]);
        for (unsigned u = 0; u < camera.width; ++u) {
            if (depthColumns[u] >= 0) frame.view.depth[v][u] = metres * z[depthColumns[u]];
        }
    }
    return frame;
}

}  // namespace photonav
