// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "io/image_decoder.hpp"

namespace photonav {
namespace {

constexpr std::size_t kDepthHeader = 12;  // before the PNG of compressedDepth
constexpr int kToGrey = cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION;

struct Encoding {
    const char* name;
    int type;                     ///< OpenCV's
    std::optional<int> toGrey{};  ///< OpenCV's conversion
};

constexpr std::array<Encoding, 8> kEncodings{{{"mono8", CV_8UC1},
                                              {"8UC1", CV_8UC1},
                                              {"rgb8", CV_8UC3, cv::COLOR_RGB2GRAY},
                                              {"bgr8", CV_8UC3, cv::COLOR_BGR2GRAY},
                                              {"rgba8", CV_8UC4, cv::COLOR_RGBA2GRAY},
                                              {"bgra8", CV_8UC4, cv::COLOR_BGRA2GRAY},
                                              {"16UC1", CV_16UC1},
                                              {"32FC1", CV_32FC1}}};

const Encoding* find(const std::string& name) {
    for (const Encoding& encoding : kEncodings) {
        if (name == encoding.name) return &encoding;
    }
    return nullptr;
}

void requireSize(std::uint64_t width, std::uint64_t height, const Camera& camera) {
    if (width == camera.width && height == camera.height) return;
    throw std::runtime_error(fmt::format("an image of {}x{} pixels, not the {}x{} of the camera",
                                         width, height, camera.width, camera.height));
}

/// A view of the message's bytes.
cv::Mat pixelsOf(const ImageMessage& image, const Camera& camera, const Encoding& encoding) {
    requireSize(image.width, image.height, camera);
    const std::size_t pixel = CV_ELEM_SIZE(encoding.type);
    if (image.step < pixel * image.width || image.step % CV_ELEM_SIZE1(encoding.type) != 0) {
        throw std::runtime_error("damaged: the rows of an image");
    }
    if (image.isBigEndian && CV_ELEM_SIZE1(encoding.type) > 1) {
        throw std::runtime_error("big-endian images are not read");
    }
    return {static_cast<int>(image.height), static_cast<int>(image.width), encoding.type,
            const_cast<std::uint8_t*>(image.data.data()), image.step};  // only read from
}

cv::Mat decoded(std::span<const std::uint8_t> bytes, int flags, const Camera& camera) {
    cv::Mat image = decodedImage(bytes, flags, [&](const ImageSize& size) {
        requireSize(size.width, size.height, camera);
        return true;
    });
    if (image.empty()) throw std::runtime_error("a compressed image is damaged");
    requireSize(static_cast<std::uint64_t>(image.cols), static_cast<std::uint64_t>(image.rows),
                camera);
    return image;
}

ImageF greyLevels(const cv::Mat& pixels) {
    constexpr float kWhiteLevel = 255.F;
    ImageF grey(static_cast<unsigned>(pixels.rows), static_cast<unsigned>(pixels.cols));
    for (int v = 0; v < pixels.rows; ++v) {
        const auto* row = pixels.ptr<std::uint8_t>(v);
        std::transform(row, row + pixels.cols, grey[static_cast<unsigned>(v)],
                       [](std::uint8_t level) { return static_cast<float>(level) / kWhiteLevel; });
    }
    return grey;
}

ImageF depthOf(const cv::Mat& pixels, double scale) {
    ImageF depth(static_cast<unsigned>(pixels.rows), static_cast<unsigned>(pixels.cols));
    cv::Mat values(pixels.rows, pixels.cols, CV_32FC1, depth.bitmap);
    pixels.convertTo(values, CV_32F, 1. / scale);
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        if (!(depth.bitmap[i] > 0.F) || !std::isfinite(depth.bitmap[i])) depth.bitmap[i] = 0.F;
    }
    return depth;
}

}  // namespace

ImageContent contentOf(const std::string& encoding) {
    const Encoding* known = find(encoding);
    if (!known) return ImageContent::other;
    return CV_MAT_DEPTH(known->type) == CV_8U ? ImageContent::grey : ImageContent::depth;
}

ImageContent contentOfFormat(const std::string& format) {
    const bool isDepth = format.find("compressedDepth") != std::string::npos;
    return isDepth ? ImageContent::depth : ImageContent::grey;
}

ImageF greyOf(const ImageMessage& image, const Camera& camera) {
    const Encoding* encoding = find(image.encoding);
    if (!encoding || contentOf(image.encoding) != ImageContent::grey) {
        throw std::runtime_error(fmt::format("encoding '{}' is no grey image", image.encoding));
    }
    cv::Mat pixels = pixelsOf(image, camera, *encoding);
    if (encoding->toGrey) {
        cv::Mat grey;
        cv::cvtColor(pixels, grey, *encoding->toGrey);
        pixels = grey;
    }
    return greyLevels(pixels);
}

ImageF greyOf(const CompressedImageMessage& image, const Camera& camera) {
    return greyLevels(decoded(image.data, kToGrey, camera));
}

ImageF depthOf(const ImageMessage& image, const Camera& camera, double scale) {
    const Encoding* encoding = find(image.encoding);
    if (!encoding || contentOf(image.encoding) != ImageContent::depth) {
        throw std::runtime_error(fmt::format("encoding '{}' is no depth image", image.encoding));
    }
    return depthOf(pixelsOf(image, camera, *encoding), scale);
}

ImageF depthOf(const CompressedImageMessage& image, const Camera& camera, double scale) {
    if (!image.format.starts_with("16UC1") || image.data.size() < kDepthHeader) {
        throw std::runtime_error(
            fmt::format("compressed depth '{}' is not one of 16 bits", image.format));
    }
    const cv::Mat pixels = decoded(image.data.subspan(kDepthHeader), cv::IMREAD_UNCHANGED, camera);
    if (pixels.type() != CV_16UC1) throw std::runtime_error("compressed depth is not of 16 bits");
    return depthOf(pixels, scale);
}

}  // namespace photonav
