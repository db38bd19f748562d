// SPDX-License-Identifier: BSD-3-Clause
// Sparse models of COLMAP as text: a camera and the poses of its images.
#pragma once

#include <string>
#include <vector>

#include "dataset/sequence.hpp"

namespace photonav {

/// Whether a folder holds a model, in it, in sparse/ or in sparse/0/: cameras.txt and images.txt,
/// or a binary one: readColmapSequence() refuses it and names the command that converts it.
bool isColmapFolder(const std::string& folder);

/// Reads cameras.txt and images.txt, but does not load the images, which lie in the subfolder
/// images/ if it exists, else in the folder. The images have no depth and no times: they are sorted
/// by name (numbers in names by value) and placed one second apart. The unit of length is that of
/// the model.
/// @throws InputError naming file, line and reason: for a camera with distortion, images of
///         different cameras, a value that is not a finite number, a quaternion whose norm is not
///         within 0.1 of 1, an image listed twice, or a model without images
Sequence readColmapSequence(const std::string& folder);

/// An image of a model to be written.
struct ColmapImage {
    std::string name;  ///< file name, relative to the image folder that COLMAP is given
    Pose T_c_w = Pose::Identity();
};

/// Writes cameras.txt (PINHOLE), images.txt and points3D.txt, without points. Images are numbered
/// from 1 on by their sorted names, as in the database that COLMAP makes of the same images with
/// one thread: COLMAP matches the images of model and database by their numbers.
/// @throws InputError when a file cannot be written
void writeColmapModel(const std::string& folder, const Camera& camera,
                      std::vector<ColmapImage> images);

}  // namespace photonav
