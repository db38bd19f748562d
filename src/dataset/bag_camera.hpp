// SPDX-License-Identifier: BSD-3-Clause
// The camera of a bag's images, and the correction of its lens.
#pragma once

#include <memory>
#include <string>

#include "bag/bag_messages.hpp"
#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// Undistorts the images of a camera with lens distortion.
class LensCorrection {
  public:
    virtual ~LensCorrection() = default;
    /// The undistorted image, interpolated bilinearly. @throws std::runtime_error for an image of
    /// another size
    virtual ImageF corrected(const ImageF& image) const = 0;
    /// The undistorted depth image. Depth is taken from the nearest pixel: interpolation would
    /// produce depths between two surfaces.
    virtual ImageF correctedDepth(const ImageF& depth) const = 0;
};

struct BagCamera {
    Camera camera;                               ///< of the undistorted images
    std::shared_ptr<const LensCorrection> lens;  ///< null: the images are already undistorted
};

/// The camera of a topic's images. If the topic's name begins with image_rect, its images are
/// rectified and P is their camera. Otherwise the images have K and D; after correction they are
/// cropped to the largest rectangle without gaps.
/// @param source bag and topic, named in error messages
/// @throws InputError for invalid camera parameters, images that are binned or cropped, and
///         distortion models other than plumb_bob and rational_polynomial
BagCamera bagCamera(const CameraInfoMessage& info, const std::string& imageTopic,
                    const std::string& source);

/// @throws InputError if depth images are not of the camera that takes the colour images
void requireRegistered(const CameraInfoMessage& depth, const CameraInfoMessage& colour,
                       const std::string& source);

}  // namespace photonav
