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
    std::optional<double> depthScale = {};  ///< value of one metre; none: 1000 of 16UC1, 1 of 32FC1
    std::string cameraFile = {};            ///< instead of the topic with the camera's parameters
    bool forgiving = false;                 ///< frames without pose are kept, as in TumOptions
    bool needsDepth = true;                 ///< as in TumOptions
    Pose T_s_c = Pose::Identity();  ///< from the camera to the frame whose poses are recorded
};

struct BagSequence {
    Sequence sequence;  ///< `colourFile` and `depthFile` name bag, topic and time: no files
    BagTopics topics;   ///< that were read
    bool isUndistorted = false;  ///< images are: the camera's lens distorts
    /// The images of a frame. @throws InputError for those that cannot be used
    std::function<View(std::size_t frame)> view;
};

/// Reads where the messages of a bag are, and all poses, but keeps no image.
///
/// Images are sensor_msgs/Image (8-bit grey or colour) or CompressedImage; depth images are 16UC1,
/// 32FC1 or compressedDepth, registered to the images, or, with a camera file that says so, of a
/// camera beside. Intrinsics are those of the sensor_msgs/CameraInfo beside the image's topic, K
/// and D; of a topic called image_rect..., P. Images are undistorted for the models plumb_bob and
/// rational_polynomial, so that all their pixels were seen. Poses (T_w_s) are those of
/// isPoseType(). Messages are placed in time by the stamps of their headers, those without stamp by
/// when they were recorded.
/// @throws InputError naming the bag and the reason: for a bag that is damaged, topics of which
///         there is none or more than one, another distortion model, and cameras of other sizes
BagSequence readBagSequence(const std::string& file, const BagOptions& options = {});

}  // namespace photonav
