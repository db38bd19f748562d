// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "io/error.hpp"
#include "io/image_decoder.hpp"
#include "io/reading.hpp"
#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

cv::Mat readImage(const std::string& file, int flags, const Camera& camera,
                  const std::string& source) {
    const auto isOfCamera = [&](const ImageSize& size) {
        if (size.width == camera.width && size.height == camera.height) return true;
        throw InputError(file, "",
                         fmt::format("{}x{} pixels, not the {}x{} of {}", size.width, size.height,
                                     camera.width, camera.height, source));
    };
    cv::Mat image = decodedImage(readBytes(file), flags, isOfCamera);
    if (image.empty()) throw InputError(file, "", "not an image, or damaged");
    isOfCamera({static_cast<std::uint64_t>(image.cols), static_cast<std::uint64_t>(image.rows)});
    return image;
}

/// An image whose values are functions of the levels of a decoded one.
template <class Value, class Level, class Convert>
vpImage<Value> converted(const cv::Mat& levels, const Convert& convert) {
    vpImage<Value> result(static_cast<unsigned>(levels.rows), static_cast<unsigned>(levels.cols));
    for (int v = 0; v < levels.rows; ++v) {
        const Level* row = levels.ptr<Level>(v);
        std::transform(row, row + levels.cols, result[v], convert);
    }
    return result;
}

}  // namespace

vpImage<unsigned char> readGrey8(const std::string& file, const Camera& camera,
                                 const std::string& source) {
    constexpr int kFlags = cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION;
    return reading(file, [&] {
        const cv::Mat levels = readImage(file, kFlags, camera, source);
        return converted<unsigned char, unsigned char>(levels, std::identity());
    });
}

ImageF readDepth16(const std::string& file, const Camera& camera, const std::string& source,
                   double unit) {
    return reading(file, [&] {
        const cv::Mat levels = readImage(file, cv::IMREAD_UNCHANGED, camera, source);
        if (levels.type() != CV_16UC1) {
            throw InputError(file, "", "expected one channel of 16 bits");
        }
        const auto metres = [unit = static_cast<float>(unit)](std::uint16_t level) {
            return unit * static_cast<float>(level);
        };
        return converted<float, std::uint16_t>(levels, metres);
    });
}

std::string greyPng(const ImageF& image, unsigned maxSide) {
    if (image.getSize() == 0) throw std::invalid_argument("greyPng: the image is empty");
    cv::Mat grey = asMat(image);
    const double factor = static_cast<double>(maxSide) / std::max(grey.rows, grey.cols);
    if (factor < 1.) cv::resize(grey, grey, {}, factor, factor, cv::INTER_AREA);
    cv::Mat1b levels(grey.size());
    std::transform(grey.begin<float>(), grey.end<float>(), levels.begin(), greyLevel);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", levels, bytes);
    return {bytes.begin(), bytes.end()};
}

}  // namespace photonav
