// SPDX-License-Identifier: BSD-3-Clause
// Registers the depth images of a separate depth camera to the colour camera.
#pragma once

#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// A camera that takes depth images which are not registered to the colour images.
struct DepthCamera {
    Camera camera;
    Pose T_c_d = Pose::Identity();  ///< maps from the depth camera's frame to the colour camera's
    bool hasPoses = false;          ///< recorded poses are those of the depth camera
};

/// The depth of the surfaces that a depth image shows, at the pixels of the colour camera: four
/// neighbours of the depth image span a surface unless their depths are spread by more than a
/// twentieth, and the nearest surface counts.
/// @param depth_d z in the depth camera's frame [m]; 0: not measured
/// @return z in the colour camera's frame [m]; 0: not measured
/// @throws std::invalid_argument for a depth image of another size than its camera's
ImageF registeredDepth(const ImageF& depth_d, const DepthCamera& from, const Camera& colour);

}  // namespace photonav
