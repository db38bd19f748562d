// SPDX-License-Identifier: BSD-3-Clause
// The ROS messages that a recording consists of. `data` members refer to the bytes that a message
// was parsed from and must not outlive them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// sensor_msgs/Image
struct ImageMessage {
    double stamp = 0.;  ///< time stamp in the header [s]; 0: none
    std::uint32_t width = 0, height = 0;
    std::uint32_t step = 0;  ///< bytes of a row
    std::string encoding;    ///< "mono8", "16UC1", ...
    bool isBigEndian = false;
    std::span<const std::uint8_t> data;  ///< height rows
};

/// sensor_msgs/CompressedImage
struct CompressedImageMessage {
    double stamp = 0.;
    std::string format;  ///< "rgb8; jpeg compressed bgr8", "16UC1; compressedDepth", ...
    std::span<const std::uint8_t> data;
};

/// sensor_msgs/CameraInfo
struct CameraInfoMessage {
    std::uint32_t width = 0, height = 0;
    std::string distortionModel;
    std::vector<double> D;
    std::array<double, 9> K{};   ///< row by row, for the image before rectification
    std::array<double, 12> P{};  ///< row by row, for the rectified image
    bool isPart = false;         ///< binned or cropped
};

/// A pose message of any type that isPoseType() accepts.
struct PoseMessage {
    double stamp = 0.;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< as stored; may have any norm
};

// All throw std::runtime_error for a message that is damaged.

ImageMessage parseImage(std::span<const std::uint8_t> message);
CompressedImageMessage parseCompressedImage(std::span<const std::uint8_t> message);
CameraInfoMessage parseCameraInfo(std::span<const std::uint8_t> message);

/// Whether parsePoseMessage() can parse a type: PoseStamped, PoseWithCovarianceStamped and
/// TransformStamped of geometry_msgs, and nav_msgs/Odometry.
bool isPoseType(const std::string& type);
PoseMessage parsePoseMessage(const std::string& type, std::span<const std::uint8_t> message);

}  // namespace photonav
