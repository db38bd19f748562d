// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/sequence_bag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bag/bag_file.hpp"
#include "dataset/association.hpp"
#include "dataset/bag_camera.hpp"
#include "dataset/bag_contents.hpp"
#include "dataset/camera_file.hpp"
#include "dataset/time_order.hpp"
#include "dataset/trajectory.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace {

template <typename Stamped>
std::vector<double> timesOfAll(const std::vector<Stamped>& all) {
    std::vector<double> times(all.size());
    std::ranges::transform(all, times.begin(), &Stamped::timestamp);
    return times;
}

/// The messages in order of time; the others are skipped.
std::vector<StampedMessage> inOrder(const std::string& name, const std::vector<StampedMessage>& all,
                                    Sequence& sequence) {
    const std::vector<double> times = timesOfAll(all);
    const auto kept = inOrderOfTime(times, Repeats::skipped);
    std::vector<StampedMessage> ordered;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (kept[i]) {
            ordered.push_back(all[i]);
        } else {
            sequence.skipped.push_back(
                {fmt::format("{} at {:.6f} s", name, times[i]), "its time repeats or goes back"});
        }
    }
    return ordered;
}

Trajectory inOrder(const Trajectory& all) {
    const auto kept = inOrderOfTime(timesOfAll(all), Repeats::kept);
    Trajectory ordered;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (kept[i]) ordered.push_back(all[i]);
    }
    return ordered;
}

/// A frame's messages.
struct BagFrame {
    BagMessage image;
    std::optional<BagMessage> depth;
};

std::vector<BagFrame> addFrames(const BagContents& contents, const BagTopics& topics,
                                const BagOptions& options, const std::string& file,
                                Sequence& sequence) {
    const auto images = inOrder(topics.image, contents.topics.at(topics.image).images, sequence);
    sequence.recorded = contents.topics.at(topics.image).images.size();
    std::vector<StampedMessage> depths;
    if (!topics.depth.empty()) {
        depths = inOrder(topics.depth, contents.topics.at(topics.depth).images, sequence);
    }
    const auto nameOf = [&](const std::string& topic, double time) {
        return fmt::format("{} ({} at {:.6f} s)", file, topic, time);
    };
    const auto partner = associate(timesOfAll(images), timesOfAll(depths), options.tolerance);
    std::vector<BagFrame> frames;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const double time = images[i].timestamp;
        const std::string name = nameOf(topics.image, time);
        const bool hasDepth = partner[i] >= 0;
        if (!hasDepth && options.needsDepth) {
            sequence.skipped.push_back(
                {name, fmt::format("no depth image within {} s", options.tolerance)});
            continue;
        }
        sequence.frames.push_back({time, Pose::Identity(), false, name, ""});
        frames.push_back({images[i].where, {}});
        if (!hasDepth) continue;
        const StampedMessage& depth = depths[static_cast<std::size_t>(partner[i])];
        sequence.frames.back().depthFile = nameOf(topics.depth, depth.timestamp);
        frames.back().depth = depth.where;
    }
    if (!frames.empty()) return frames;
    throw InputError(file, "",
                     fmt::format("no depth image within {} s of any image", options.tolerance));
}

void addPoses(const Trajectory& trajectory, const BagOptions& options, const std::string& file,
              Sequence& sequence) {
    if (trajectory.empty()) return;
    const auto& beside = sequence.depthCamera;
    const Pose T_colour_posed = beside && beside->hasPoses ? beside->T_c_d : Pose::Identity();
    for (Sequence::Entry& frame : sequence.frames) {
        const auto T_w_s =
            poseAt(trajectory, frame.timestamp, options.tolerance, options.maxPoseGap);
        frame.hasPose = T_w_s.has_value();
        if (T_w_s) frame.T_c_w = T_colour_posed * (*T_w_s * options.T_s_c).inverse();
    }
    if (!sequence.hasPoses()) {
        throw noPoseNear(file, trajectory, options.tolerance, sequence.frames.front().timestamp,
                         sequence.frames.back().timestamp);
    }
}

/// What loads the images of frames.
struct FrameLoader {
    std::shared_ptr<BagFile> bag;
    std::vector<BagFrame> frames;
    Sequence sequence;
    bool isImageCompressed = false, isDepthCompressed = false;
    std::shared_ptr<const LensCorrection> lens;

    ImageF grey(std::size_t i) const {
        const auto bytes = bag->read(frames[i].image);
        const ImageF grey = isImageCompressed ? greyOf(parseCompressedImage(bytes), sequence.camera)
                                              : greyOf(parseImage(bytes), sequence.camera);
        return lens ? lens->corrected(grey) : grey;
    }

    ImageF metres(std::size_t i) const {
        const auto& beside = sequence.depthCamera;
        const Camera& camera = beside ? beside->camera : sequence.camera;
        const auto bytes = bag->read(*frames[i].depth);
        const double scale = sequence.depthScale;
        const ImageF metres = isDepthCompressed
                                  ? depthOf(parseCompressedImage(bytes), camera, scale)
                                  : depthOf(parseImage(bytes), camera, scale);
        if (beside) return registeredDepth(metres, *beside, sequence.camera);
        return lens ? lens->correctedDepth(metres) : metres;
    }

    View operator()(std::size_t i) const {
        const Sequence::Entry& entry = sequence.frames.at(i);
        View view;
        view.intensity = reading(entry.colourFile, [&] { return grey(i); });
        view.depth.resize(sequence.camera.height, sequence.camera.width, 0.F);
        if (!frames[i].depth) return view;
        try {
            view.depth = reading(entry.depthFile, [&] { return metres(i); });
        } catch (const InputError&) {
            if (sequence.needsDepth) throw;
        }
        return view;
    }
};

/// @returns the correction of the images' lens, or null
std::shared_ptr<const LensCorrection> setCamera(const BagContents& contents,
                                                const BagTopics& topics, const BagOptions& options,
                                                const std::string& file, Sequence& sequence) {
    if (!options.cameraFile.empty()) {
        readCameraFile(options.cameraFile, sequence);
        return nullptr;
    }
    const auto nameOf = [&](const std::string& topic) { return file + " (" + topic + ")"; };
    const CameraInfoMessage& info = *contents.topics.at(topics.camera).camera;
    const BagCamera camera = bagCamera(info, topics.image, nameOf(topics.camera));
    sequence.camera = camera.camera;
    const std::string ofDepth = cameraBeside(topics.depth, contents);
    if (!ofDepth.empty() && ofDepth != topics.camera) {
        requireRegistered(*contents.topics.at(ofDepth).camera, info, nameOf(ofDepth));
    }
    return camera.lens;
}

BagSequence sequenceOf(const std::string& file, const BagOptions& options) {
    constexpr double kMillimetres = 1000.;
    const auto bag = std::make_shared<BagFile>(file);
    const BagContents contents = contentsOf(*bag);
    BagSequence result;
    const BagTopics& topics = result.topics = chosenTopics(file, contents, options);
    const TopicContents& images = contents.topics.at(topics.image);
    const TopicContents depths =
        topics.depth.empty() ? TopicContents() : contents.topics.at(topics.depth);
    Sequence& sequence = result.sequence;
    sequence.needsDepth = options.needsDepth;
    sequence.skipped = contents.skipped;
    sequence.depthScale = depths.encoding == "32FC1" ? 1. : kMillimetres;
    const auto lens = setCamera(contents, topics, options, file, sequence);
    if (options.depthScale) sequence.depthScale = *options.depthScale;
    result.isUndistorted = lens != nullptr;
    const auto frames = addFrames(contents, topics, options, file, sequence);
    if (!topics.pose.empty()) {
        addPoses(inOrder(contents.topics.at(topics.pose).poses), options, file, sequence);
    }
    result.view =
        FrameLoader{bag, frames, sequence, images.isCompressed(), depths.isCompressed(), lens};
    return result;
}

}  // namespace

BagSequence readBagSequence(const std::string& file, const BagOptions& options) {
    return reading(file, [&] { return sequenceOf(file, options); });
}

}  // namespace photonav
