// SPDX-License-Identifier: BSD-3-Clause
// Reads recorded images, with their size checked against the camera's, and writes grey ones.
#pragma once

#include <string>

#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// An image of a recording's list.
struct StampedFile {
    double timestamp = 0.;  ///< [s]
    std::string file;
};

/// Reads an 8-bit grey image. Colour is converted with OpenCV's weights; orientation tags are
/// ignored.
/// @param source the file and keys that give the camera's size, named in error messages:
///         "camera.yaml (width, height)"
/// @throws InputError for a file that is missing, damaged or of another size than the camera's
vpImage<unsigned char> readGrey8(const std::string& file, const Camera& camera,
                                 const std::string& source);

/// Reads a depth image of 16 bits.
/// @param unit depth of one level [m]
/// @return depth z [m]; 0: none
/// @throws InputError as readGrey8(), and unless the image has one channel of 16 bits
ImageF readDepth16(const std::string& file, const Camera& camera, const std::string& source,
                   double unit);

/// The bytes of a PNG file of a grey image in [0, 1], reduced to at most `maxSide` pixels a side.
/// @throws std::invalid_argument if the image is empty
std::string greyPng(const ImageF& image, unsigned maxSide = 2048);

}  // namespace photonav
