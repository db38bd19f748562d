// SPDX-License-Identifier: BSD-3-Clause
// The messages of ROS that a recording is made of. Data refer to the bytes they were read from.
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
    double stamp = 0.;  ///< of its header [s]; 0: none
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
    std::array<double, 9> K{};   ///< by rows, of the image as it was taken
    std::array<double, 12> P{};  ///< by rows, of the rectified image
    bool isPart = false;         ///< binned or cropped
};

/// What a topic with poses says.
struct PoseMessage {
    double stamp = 0.;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< as it is, of any norm
};

// All throw std::runtime_error for a message that is damaged.

ImageMessage parseImage(std::span<const std::uint8_t> message);
CompressedImageMessage parseCompressedImage(std::span<const std::uint8_t> message);
CameraInfoMessage parseCameraInfo(std::span<const std::uint8_t> message);

/// Whether parsePoseMessage() knows a type: PoseStamped, PoseWithCovarianceStamped and
/// TransformStamped of geometry_msgs, and nav_msgs/Odometry.
bool isPoseType(const std::string& type);
PoseMessage parsePoseMessage(const std::string& type, std::span<const std::uint8_t> message);

}  // namespace photonav
