// SPDX-License-Identifier: BSD-3-Clause
// Recorded images, of the size that their camera says.
#pragma once

#include <cstdint>
#include <string>

#include "camera.hpp"

namespace photonav {

/// An image of a recording's list.
struct StampedFile {
    double timestamp = 0.;  ///< [s]
    std::string file;
};

/// Colour becomes grey as OpenCV weighs it; orientation tags are ignored.
/// @param source what says the camera's size, for messages: "camera.yaml (width, height)"
/// @throws InputError for a file that is missing, damaged or of another size than the camera's
vpImage<unsigned char> readGrey8(const std::string& file, const Camera& camera,
                                 const std::string& source);

/// @throws InputError as readGrey8(), and unless the image has one channel of 16 bits
vpImage<std::uint16_t> readDepth16(const std::string& file, const Camera& camera,
                                   const std::string& source);

}  // namespace photonav
