// SPDX-License-Identifier: BSD-3-Clause
// JSON messages for Foxglove's panels, in the frame "world" (z up, metres). Their fields are
// defined by docs.foxglove.dev/docs/visualization/message-schemas.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shapes/paths.hpp"

namespace photonav {

/// Points with grey values.
struct GreyPoints {
    std::vector<float> positions;    ///< 3 per point, world frame [m]
    std::vector<std::uint8_t> grey;  ///< 1 per point

    void add(const Eigen::Vector3f& position, std::uint8_t value);
};

/// The JSON Schema of a kind of message.
/// @param name foxglove.PoseInFrame, foxglove.PointCloud, foxglove.CompressedImage,
///        foxglove.SceneUpdate or photonav.Belief
/// @throws std::invalid_argument for another name
const std::string& messageSchema(std::string_view name);

// The messages. Times are in seconds.

std::string poseMessage(double time, const Pose& T_w_c);
std::string pointCloudMessage(double time, const GreyPoints& points);
/// @param bytes content of the image file
/// @param format "jpeg" or "png"
std::string imageMessage(double time, std::string_view bytes, const std::string& format);
/// A path as a line, with 3-sigma ellipsoids of the position at about fifty places. It replaces an
/// earlier path of the same name.
std::string pathMessage(double time, const DrawnPath& path);
/// Numbers for plots: distance along the path [m], standard deviation of the position (square root
/// of the trace of its covariance) [m], weighted trace [m^2].
std::string beliefMessage(const PathPoint& point);

}  // namespace photonav
