// SPDX-License-Identifier: BSD-3-Clause
#include "recording/bag_recording.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "bag/bag_file.hpp"
#include "dataset/sequence_bag.hpp"
#include "io/error.hpp"

namespace photonav {
namespace {

BagTopics parseTopics(const std::string& text) {
    BagTopics topics;
    const std::array<std::pair<std::string_view, std::string*>, 4> purposes{
        {{"image", &topics.image},
         {"depth", &topics.depth},
         {"camera", &topics.camera},
         {"pose", &topics.pose}}};
    for (std::string_view rest = text; !rest.empty();) {
        const std::string_view item = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), item.size() + 1));
        const std::string_view name = item.substr(0, item.find('='));
        std::string* topic = nullptr;
        for (const auto& [purpose, named] : purposes) {
            if (name == purpose && item.size() > name.size() + 1) topic = named;
        }
        if (!topic) {
            throw InputError("--topics", "",
                             fmt::format("'{}' is not one of image=, depth=, camera=, pose= with a "
                                         "topic",
                                         item));
        }
        *topic = item.substr(name.size() + 1);
    }
    return topics;
}

std::string noteOn(const BagSequence& bag) {
    const auto [image, depth, camera, pose] = bag.topics;
    std::string note = "images of " + image;
    if (bag.isUndistorted) note += ", undistorted";
    if (!depth.empty()) note += ", depth of " + depth;
    if (!camera.empty()) note += ", camera of " + camera;
    return pose.empty() ? note : note + ", poses of " + pose;
}

}  // namespace

bool isBagRecording(const std::string& path) {
    const bool isCalledOne = std::filesystem::path(path).extension() == ".bag";
    return BagFile::isBag(path) || (isCalledOne && !std::filesystem::is_directory(path));
}

Recording readBagRecording(const RecordingOptions& options) {
    if (!options.stereo.empty()) throw InputError("--stereo", "", "is for EuRoC recordings");
    BagOptions bag;
    bag.topics = parseTopics(options.topics);
    bag.tolerance = options.tolerance;
    bag.depthScale = options.depthScale;
    bag.cameraFile = options.cameraFile;
    bag.forgiving = options.forgiving;
    bag.needsDepth = options.needsDepth;
    if (!options.mount.empty()) bag.T_s_c = parsePose(options.mount, "--mount");
    const BagSequence read = readBagSequence(options.dataset, bag);
    Recording recording;
    recording.layout = "ROS bag";
    recording.hasImageFiles = false;
    recording.sequence = read.sequence;
    recording.note = noteOn(read);
    recording.view = read.view;
    if (options.depthScale && !recording.sequence.hasDepth()) {
        throw InputError("--depth-scale", "", "the recording has no depth images");
    }
    return recording;
}

}  // namespace photonav
