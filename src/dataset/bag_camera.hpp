// SPDX-License-Identifier: BSD-3-Clause
// The camera of a bag's images, and the correction of its lens.
#pragma once

#include <memory>
#include <string>

#include "bag/bag_messages.hpp"
#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// Images of a lens that distorts, as a pinhole camera sees them.
class LensCorrection {
  public:
    virtual ~LensCorrection() = default;
    /// Interpolated. @throws std::runtime_error for an image of another size
    virtual ImageF corrected(const ImageF& image) const = 0;
    /// Of the nearest pixel, so that no depth between two surfaces comes up.
    virtual ImageF correctedDepth(const ImageF& depth) const = 0;
};

struct BagCamera {
    Camera camera;                               ///< of the corrected images
    std::shared_ptr<const LensCorrection> lens;  ///< null: there is nothing to correct
};

/// The camera of a topic's images. A topic called image_rect... has rectified ones, of the
/// camera P; others are of K and D, and the largest rectangle without gaps is what is left of them.
/// @param source bag and topic, for messages
/// @throws InputError for what is no camera, images that are binned or cropped, and lenses other
///         than plumb_bob and rational_polynomial
BagCamera bagCamera(const CameraInfoMessage& info, const std::string& imageTopic,
                    const std::string& source);

/// @throws InputError if depth images are not of the camera that takes the colour images
void requireRegistered(const CameraInfoMessage& depth, const CameraInfoMessage& colour,
                       const std::string& source);

}  // namespace photonav
