// SPDX-License-Identifier: BSD-3-Clause
// The topics of a bag that a recording can be made of.
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

/// What is kept of a topic's messages.
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
    std::vector<Sequence::Skipped> skipped;  ///< poses that are none
};

/// Reads a bag once, an image at a time.
/// @throws InputError for a bag that is damaged
BagContents contentsOf(BagFile& bag);

/// The topic with the parameters of the camera that a topic's images are of, by ROS's convention
/// for names; empty: there is none.
std::string cameraBeside(std::string image, const BagContents& contents);

/// The topics to read, named by the options or the only ones of their types; empty: there is none.
/// @throws InputError for what a recording needs and the bag lacks or has twice
BagTopics chosenTopics(const std::string& file, const BagContents& contents,
                       const BagOptions& options);

}  // namespace photonav
