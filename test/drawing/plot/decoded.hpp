// SPDX-License-Identifier: BSD-3-Clause
// Figures as pixels.
#pragma once

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/atomic_file.hpp"
#include "plot/picture.hpp"

namespace photonav {

/// Decodes; PHOTONAV_KEEP names a folder in which the pictures are kept to be looked at.
inline cv::Mat3b decoded(const Png& png, const std::string& name) {
    if (const char* folder = std::getenv("PHOTONAV_KEEP"))
        writeFileAtomically(std::filesystem::path(folder) / (name + ".png"), png);
    return cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

inline cv::Mat1b maskOf(const cv::Mat3b& image, const Color& color) {
    cv::Mat1b mask;
    const cv::Scalar bgr(color.blue, color.green, color.red);
    cv::inRange(image, bgr, bgr, mask);
    return mask;
}

inline int countOf(const cv::Mat3b& image, const Color& color) {
    return cv::countNonZero(maskOf(image, color));
}

/// The smallest rectangle around all pixels of a colour.
inline cv::Rect boundsOf(const cv::Mat3b& image, const Color& color) {
    return cv::boundingRect(maskOf(image, color));
}

}  // namespace photonav
