// SPDX-License-Identifier: BSD-3-Clause
// The topics of a bag that a recording can be read from.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bag/bag_file.hpp"
#include "bag/bag_images.hpp"
#include "dataset/sequence_bag.hpp"
#include "dataset/trajectory.hpp"

namespace photonav {

struct StampedMessage {
    double timestamp = 0.;  ///< [s]
    BagMessage where;
};

/// The contents of one topic.
struct TopicContents {
    std::string type;
    ImageContent content = ImageContent::other;
    std::string encoding;  ///< of the first image that is not compressed
    std::vector<StampedMessage> images;
    std::optional<CameraInfoMessage> camera;  ///< the first
    Trajectory poses;

    bool isCompressed() const;
};

struct BagContents {
    std::map<std::string, TopicContents> topics;
    std::vector<Sequence::Skipped> skipped;  ///< invalid poses
};

/// Reads a bag once, an image at a time.
/// @throws InputError for a bag that is damaged
BagContents contentsOf(BagFile& bag);

/// The camera_info topic that belongs to an image topic by ROS's naming convention; empty if there
/// is none.
std::string cameraBeside(std::string image, const BagContents& contents);

/// The topics to read: those named by the options, else the only topic of each type. A name is
/// empty if there is no such topic.
/// @throws InputError if a topic that a recording needs is missing, or is not named and there are
///         several
BagTopics chosenTopics(const std::string& file, const BagContents& contents,
                       const BagOptions& options);

}  // namespace photonav
