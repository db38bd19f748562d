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

/// The JSON Schema of messages: PoseInFrame, PointCloud, CompressedImage or SceneUpdate of
/// Foxglove, or photonav.Belief. @throws std::invalid_argument for another name
const std::string& messageSchema(std::string_view name);

// Messages; times in s.

std::string poseMessage(double time, const Pose& T_w_c);
std::string pointCloudMessage(double time, const GreyPoints& points);
/// @param format "jpeg" or "png"
std::string imageMessage(double time, std::string_view bytes, const std::string& format);
/// A path as a line, with ellipsoids of three standard deviations of the position at some fifty
/// places. It replaces an earlier one of that name.
std::string pathMessage(double time, const DrawnPath& path);
/// Numbers for plots: way [m], standard deviation of the position [m], weighted trace [m^2].
std::string beliefMessage(const PathPoint& point);

}  // namespace photonav
