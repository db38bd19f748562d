// SPDX-License-Identifier: BSD-3-Clause
#include "image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "error.hpp"
#include "image_bytes.hpp"

namespace photonav {
namespace {

cv::Mat readImage(const std::string& file, int flags, const Camera& camera,
                  const std::string& source) {
    const auto bytes = soundImage(readBytes(file));
    cv::Mat image = bytes.empty() ? cv::Mat() : cv::imdecode(bytes, flags);
    if (image.empty()) throw InputError(file, "", "not an image, or damaged");
    if (image.cols != int(camera.width) || image.rows != int(camera.height)) {
        throw InputError(file, "",
                         fmt::format("{}x{} pixels, not the {}x{} of {}", image.cols, image.rows,
                                     camera.width, camera.height, source));
    }
    return image;
}

template <class Value>
vpImage<Value> copied(const cv::Mat& image) {
    vpImage<Value> result(static_cast<unsigned>(image.rows), static_cast<unsigned>(image.cols));
    for (int v = 0; v < image.rows; ++v) {
        const Value* row = image.ptr<Value>(v);
        std::copy(row, row + image.cols, result[v]);
    }
    return result;
}

}  // namespace

vpImage<unsigned char> readGrey8(const std::string& file, const Camera& camera,
                                 const std::string& source) {
    return copied<unsigned char>(
        readImage(file, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION, camera, source));
}

vpImage<std::uint16_t> readDepth16(const std::string& file, const Camera& camera,
                                   const std::string& source) {
    const cv::Mat image = readImage(file, cv::IMREAD_UNCHANGED, camera, source);
    if (image.type() != CV_16UC1) throw InputError(file, "", "expected one channel of 16 bits");
    return copied<std::uint16_t>(image);
}

}  // namespace photonav
