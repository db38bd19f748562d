// SPDX-License-Identifier: BSD-3-Clause
// Views on a contact sheet.
#pragma once

#include <opencv2/imgproc.hpp>

#include "types.hpp"

/// A view, its depth or its contributions as grey values, twice enlarged, in a white frame.
/// @param scale what is multiplied to get from the image's values to [0, 1]
inline cv::Mat picture(const photonav::ImageF& image, double scale = 1.) {
    const cv::Mat grey(static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()),
                       CV_32F, image.bitmap);
    cv::Mat bytes, large;
    grey.convertTo(bytes, CV_8U, 255. * scale);
    cv::resize(bytes, large, {}, 2., 2., cv::INTER_NEAREST);
    cv::copyMakeBorder(large, large, 4, 4, 4, 4, cv::BORDER_CONSTANT, {255});
    return large;
}
