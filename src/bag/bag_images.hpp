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

/// The same of a compressed image's format: depth of compressedDepth, grey of all else.
ImageContent contentOfFormat(const std::string& format);

/// Grey values in [0, 1]; colour as OpenCV weighs it.
/// @throws std::runtime_error for another size than the camera's and for what is damaged
ImageF greyOf(const ImageMessage& image, const Camera& camera);
ImageF greyOf(const CompressedImageMessage& image, const Camera& camera);

/// Depth in metres; 0: none.
/// @param scale value of one metre: 1000 of 16UC1 by ROS's convention, 1 of 32FC1
/// @throws std::runtime_error as greyOf(), and for compressed 32-bit depth
ImageF depthOf(const ImageMessage& image, const Camera& camera, double scale);
ImageF depthOf(const CompressedImageMessage& image, const Camera& camera, double scale);

}  // namespace photonav
