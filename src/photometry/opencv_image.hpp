// SPDX-License-Identifier: BSD-3-Clause
// Images for OpenCV. Not installed: no public header includes OpenCV.
#pragma once

#include <opencv2/core.hpp>

#include "photometry/view.hpp"

namespace photonav {

/// The image as an OpenCV matrix that shares its pixels. The image must outlive the matrix.
inline cv::Mat asMat(const ImageF& image) {
    return {static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()), CV_32F,
            image.bitmap};
}

}  // namespace photonav
