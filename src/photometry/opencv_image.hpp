// SPDX-License-Identifier: BSD-3-Clause
// Images for OpenCV. Not installed: no public header includes OpenCV.
#pragma once

#include <opencv2/core.hpp>

#include "photometry/view.hpp"

namespace photonav {

/// The same pixels for OpenCV.
inline cv::Mat asMat(const ImageF& image) {
    return {static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()), CV_32F,
            image.bitmap};
}

}  // namespace photonav
