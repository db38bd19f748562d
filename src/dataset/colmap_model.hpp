// SPDX-License-Identifier: BSD-3-Clause
// Sparse models of COLMAP as text: a camera and the poses of its images.
#pragma once

#include <string>
#include <vector>

#include "dataset/sequence.hpp"

namespace photonav {

/// Whether a folder holds a text model: cameras.txt and images.txt, in it, in sparse/ or in
/// sparse/0/.
bool isColmapFolder(const std::string& folder);

/// Reads cameras.txt and images.txt, no images. Those lie in the folder's images/ where there is
/// one, else in the folder. They have no depth, and no times: they are taken in the order of their
/// names, numbers in these by their values, a second apart. The unit of length is the model's.
/// @throws InputError naming file, line and reason: for a camera with distortion, images of
///         different cameras, what is not a finite number, a quaternion whose norm is not within
///         0.1 of 1, an image listed twice, or a model without images
Sequence readColmapSequence(const std::string& folder);

/// An image of a model to be written.
struct ColmapImage {
    std::string name;  ///< of its file, in the folder that COLMAP is given
    Pose T_c_w = Pose::Identity();
};

/// Writes cameras.txt (PINHOLE), images.txt and points3D.txt, without points.
/// @throws InputError when a file cannot be written
void writeColmapModel(const std::string& folder, const Camera& camera,
                      const std::vector<ColmapImage>& images);

}  // namespace photonav
