// SPDX-License-Identifier: BSD-3-Clause
// Pixels of image messages.
#pragma once

#include <string>

#include "bag/bag_messages.hpp"
#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

enum class ImageContent { grey, depth, other };

/// What images of an encoding show: grey values (mono8, 8UC1, rgb8, bgr8, rgba8, bgra8), or depth
/// (16UC1, 32FC1).
ImageContent contentOf(const std::string& encoding);

/// What compressed images of a format show: depth for compressedDepth, grey values for all other
/// formats.
ImageContent contentOfFormat(const std::string& format);

/// Grey values in [0, 1]; colour is converted with OpenCV's weights.
/// @throws std::runtime_error for an image that is damaged or does not have the camera's size
ImageF greyOf(const ImageMessage& image, const Camera& camera);
ImageF greyOf(const CompressedImageMessage& image, const Camera& camera);

/// Depth along the optical axis [m]; 0: not measured.
/// @param scale stored value of one metre; by ROS's convention 1000 for 16UC1 and 1 for 32FC1
/// @throws std::runtime_error as greyOf(), and for compressed 32-bit depth
ImageF depthOf(const ImageMessage& image, const Camera& camera, double scale);
ImageF depthOf(const CompressedImageMessage& image, const Camera& camera, double scale);

}  // namespace photonav
