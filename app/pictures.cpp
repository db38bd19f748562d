// SPDX-License-Identifier: BSD-3-Clause
#include "pictures.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace photonav {
namespace {

cv::Mat1f toMat(const ImageF& image) {
    if (image.getSize() == 0) throw std::invalid_argument("picture: the image is empty");
    cv::Mat1f mat(static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()));
    std::copy_n(image.bitmap, image.getSize(), mat.begin());
    return mat;
}

Png encoded(const cv::Mat& image) {
    std::vector<unsigned char> bytes;
    cv::imencode(".png", image, bytes);
    return {bytes.begin(), bytes.end()};
}

/// The value that the fraction `rank` of all pixels does not exceed.
float percentile(const cv::Mat1f& image, double rank) {
    std::vector<float> values(image.begin(), image.end());
    const auto nth =
        values.begin() + static_cast<std::ptrdiff_t>(rank * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

}  // namespace

Png greyPng(const ImageF& image, unsigned maxSide) {
    cv::Mat1f grey = toMat(image);
    const double factor = static_cast<double>(maxSide) / std::max(grey.rows, grey.cols);
    if (factor < 1.0) cv::resize(grey, grey, {}, factor, factor, cv::INTER_AREA);
    cv::Mat1b bytes;
    grey.convertTo(bytes, CV_8U, 255.0);
    return encoded(bytes);
}

Png contributionPng(const ImageF& intensity, const ImageF& contribution) {
    const cv::Mat1f grey = toMat(intensity);
    cv::Mat1f weight = toMat(contribution);
    if (grey.size() != weight.size())
        throw std::invalid_argument("contributionPng: images of different size");
    cv::sqrt(weight, weight);
    const float top = percentile(weight, 0.995);
    weight = cv::min(weight / std::max(top, 1e-12F), 1.0F);

    cv::Mat1b level;
    weight.convertTo(level, CV_8U, 255.0);
    cv::Mat3b picture;
    cv::applyColorMap(level, picture, cv::COLORMAP_INFERNO);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const float opacity = std::min(1.0F, 2.0F * weight(y, x));
            const float dimmed = 0.45F * 255.0F * grey(y, x);
            cv::Vec3b& pixel = picture(y, x);
            for (int k = 0; k < 3; ++k)
                pixel[k] = cv::saturate_cast<unsigned char>(opacity * static_cast<float>(pixel[k]) +
                                                            (1.0F - opacity) * dimmed);
        }
    return encoded(picture);
}

}  // namespace photonav
