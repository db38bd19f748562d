// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes camera.yaml, the camera parameters of a recording.
#pragma once

#include <string>

#include "dataset/sequence.hpp"

namespace photonav {

/// Reads a camera file into `sequence`: width, height, fx, fy, cx, cy [pixels], depth_scale,
/// information_scale, blur (point spread [pixels]), depth_error (relative, of its scale and
/// registration), and for depth images that are not registered to the colour images `depth_camera`
/// with its own fx, fy, cx, cy, width and height (those of the colour camera), T_colour_depth (`[x,
/// y, z, qx, qy, qz, qw]`, default: the same place) and whose poses are recorded (poses: colour, or
/// depth).
/// @throws InputError naming file, key and reason
void readCameraFile(const std::string& file, Sequence& sequence);

/// The text of a camera.yaml with all camera parameters of the sequence.
std::string cameraYaml(const Sequence& sequence);

}  // namespace photonav
