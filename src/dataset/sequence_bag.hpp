// SPDX-License-Identifier: BSD-3-Clause
// Recordings in a ROS 1 bag.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "dataset/sequence.hpp"

namespace photonav {

/// Names of topics; empty: the only one of its type.
struct BagTopics {
    std::string image, depth, camera, pose;
};

struct BagOptions {
    BagTopics topics = {};
    double tolerance = 0.02;  ///< largest time between images, or image and pose [s]
    double maxPoseGap = 0.1;  ///< interpolate between poses at most this far apart [s]
    /// Stored value of one metre; none: 1000 for 16UC1, 1 for 32FC1.
    std::optional<double> depthScale = {};
    std::string cameraFile = {};  ///< instead of the topic with the camera's parameters
    bool forgiving = false;       ///< frames without pose are kept, as in TumOptions
    bool needsDepth = true;       ///< as in TumOptions
    /// Maps from the camera frame to the frame s whose poses are recorded.
    Pose T_s_c = Pose::Identity();
};

struct BagSequence {
    Sequence sequence;  ///< `colourFile` and `depthFile` name bag, topic and time: no files
    BagTopics topics;   ///< topics that were read
    /// The recorded images have lens distortion, which view() corrects.
    bool isUndistorted = false;
    /// The images of a frame. @throws InputError for those that cannot be used
    std::function<View(std::size_t frame)> view;
};

/// Reads the positions of a bag's messages and all poses, but keeps no image in memory.
///
/// Images are sensor_msgs/Image (8-bit grey or colour) or CompressedImage; depth images are 16UC1,
/// 32FC1 or compressedDepth, registered to the images, or taken by a separate depth camera that the
/// camera file describes. Intrinsics are read from the sensor_msgs/CameraInfo that belongs to the
/// image topic: K and D, or P for a topic whose name begins with image_rect. Images are undistorted
/// for the models plumb_bob and rational_polynomial, and cropped so that every pixel was observed.
/// Poses (T_w_s) are messages of a type that isPoseType() accepts. The time of a message is its
/// header stamp, or the recording time if it has no stamp.
/// @throws InputError naming the bag and the reason: for a bag that is damaged, topics of which
///         there is none or more than one, another distortion model, and cameras of other sizes
BagSequence readBagSequence(const std::string& file, const BagOptions& options = {});

}  // namespace photonav
