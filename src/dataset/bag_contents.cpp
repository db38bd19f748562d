// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/bag_contents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/error.hpp"

namespace photonav {
namespace {

constexpr const char* kRawImage = "sensor_msgs/Image";
constexpr const char* kCompressed = "sensor_msgs/CompressedImage";
constexpr const char* kCameraInfo = "sensor_msgs/CameraInfo";

double timeOfMessage(double stamp, const BagMessage& message) {
    return stamp > 0. ? stamp : message.received;
}

void addImage(TopicContents& topic, const BagMessage& message,
              std::span<const std::uint8_t> bytes) {
    const bool isFirst = topic.images.empty();
    if (topic.type == kRawImage) {
        const ImageMessage image = parseImage(bytes);
        if (isFirst) topic.encoding = image.encoding;
        if (isFirst) topic.content = contentOf(image.encoding);
        topic.images.push_back({timeOfMessage(image.stamp, message), message});
    } else {
        const CompressedImageMessage image = parseCompressedImage(bytes);
        if (isFirst) topic.content = contentOfFormat(image.format);
        topic.images.push_back({timeOfMessage(image.stamp, message), message});
    }
}

/// The topic that serves a purpose: the one that was named, or the only one. Empty: there is none.
class TopicChoice {
  public:
    TopicChoice(const std::string& file, const BagContents& contents)
        : file_(file), contents_(contents) {}

    template <typename Serves>
    std::string operator()(const char* purpose, const std::string& named,
                           const Serves& serves) const {
        std::vector<std::string> candidates;
        for (const auto& [name, topic] : contents_.topics) {
            if (serves(topic)) candidates.push_back(name);
        }
        const bool isNamed = !named.empty();
        const bool isThere = std::ranges::find(candidates, named) != candidates.end();
        if (isNamed && !isThere) {
            fail(fmt::format("{}={} is none that can serve as {}; there are {}", purpose, named,
                             purpose, listOf(candidates)));
        }
        if (isNamed) return named;
        if (candidates.size() > 1) {
            fail(fmt::format("choose one with {}=TOPIC: {}", purpose, listOf(candidates)));
        }
        return candidates.empty() ? std::string() : candidates.front();
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(file_, "--topics", reason);
    }

  private:
    static std::string listOf(const std::vector<std::string>& names) {
        return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
    }

    const std::string& file_;
    const BagContents& contents_;
};

std::string noteOnTf(const BagContents& contents) {
    const bool hasTf = std::ranges::any_of(contents.topics, [](const auto& topic) {
        return topic.second.type.ends_with("/TFMessage") || topic.second.type == "tf/tfMessage";
    });
    return hasTf ? "; those of /tf are not read" : "";
}

}  // namespace

bool TopicContents::isCompressed() const { return type == kCompressed; }

BagContents contentsOf(BagFile& bag) {
    BagContents contents;
    bag.forEachMessage([&](const BagTopic& of, const BagMessage& message, auto bytes) {
        TopicContents& topic = contents.topics[of.name];
        topic.type = of.type;
        if (of.type == kRawImage || of.type == kCompressed) {
            addImage(topic, message, bytes);
        } else if (of.type == kCameraInfo && !topic.camera) {
            topic.camera = parseCameraInfo(bytes);
        } else if (isPoseType(of.type)) {
            const PoseMessage pose = parsePoseMessage(of.type, bytes);
            const double time = timeOfMessage(pose.stamp, message);
            try {
                const TextRow row(bag.file(), static_cast<int>(topic.poses.size() + 1), {});
                topic.poses.push_back(poseOfRow(row, time, pose.position, pose.rotation));
            } catch (const InputError&) {
                contents.skipped.push_back(
                    {fmt::format("{} at {:.6f} s", of.name, time), "no pose"});
            }
        }
    });
    return contents;
}

/// "/camera/rgb/camera_info" of "/camera/rgb/image_raw" and "/camera/rgb/image_raw/compressed".
std::string cameraBeside(std::string image, const BagContents& contents) {
    for (int level = 0; level < 2 && image.find('/') != std::string::npos; ++level) {
        image.resize(image.rfind('/'));
        const auto beside = contents.topics.find(image + "/camera_info");
        if (beside != contents.topics.end() && beside->second.camera) return beside->first;
    }
    return {};
}

BagTopics chosenTopics(const std::string& file, const BagContents& contents,
                       const BagOptions& options) {
    const TopicChoice choose(file, contents);
    const auto shows = [](ImageContent content) {
        return
            [content](const TopicContents& t) { return !t.images.empty() && t.content == content; };
    };
    BagTopics topics;
    topics.image = choose("image", options.topics.image, shows(ImageContent::grey));
    if (topics.image.empty()) throw InputError(file, "", "no grey or colour images");
    if (options.needsDepth || !options.topics.depth.empty()) {
        topics.depth = choose("depth", options.topics.depth, shows(ImageContent::depth));
        if (topics.depth.empty()) {
            throw InputError(file, "",
                             "no depth images (16UC1, 32FC1, compressedDepth); without them there "
                             "is `map --depth monocular`, and `replay --map`");
        }
    }
    topics.pose = choose("pose", options.topics.pose,
                         [](const TopicContents& t) { return !t.poses.empty(); });
    if (topics.pose.empty() && !options.forgiving) {
        throw InputError(file, "",
                         "no poses (PoseStamped, PoseWithCovarianceStamped, TransformStamped, "
                         "Odometry)" +
                             noteOnTf(contents));
    }
    if (!options.cameraFile.empty()) return topics;
    topics.camera = options.topics.camera.empty() ? cameraBeside(topics.image, contents)
                                                  : options.topics.camera;
    topics.camera = choose("camera", topics.camera,
                           [](const TopicContents& t) { return t.camera.has_value(); });
    if (topics.camera.empty()) {
        throw InputError(file, "", "no sensor_msgs/CameraInfo: give --camera FILE");
    }
    return topics;
}

}  // namespace photonav
