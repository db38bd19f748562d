// SPDX-License-Identifier: BSD-3-Clause
#include "figures/flight_log_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "io/image_decoder.hpp"

namespace photonav {
namespace {

constexpr std::uint64_t kLargestSide = 4096;  // [pixels]
constexpr Color kUnseen{122, 130, 140}, kOccupied{24, 28, 33}, kTooNear{198, 170, 150},
    kFree{247, 247, 244};

/// The grey levels of a file; empty where it is damaged or too large.
cv::Mat decoded(const std::string& file) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.data());
    return decodedImage({bytes, file.size()}, cv::IMREAD_GRAYSCALE, [](const ImageSize& size) {
        return size.width <= kLargestSide && size.height <= kLargestSide;
    });
}

Picture pictureOf(const std::string& file, const std::function<Color(std::uint8_t)>& colorOf) {
    const cv::Mat grey = decoded(file);
    Picture picture{{}, grey.cols};
    for (int v = 0; v < grey.rows; ++v)
        for (int u = 0; u < grey.cols; ++u)
            picture.pixels.push_back(colorOf(grey.at<std::uint8_t>(v, u)));
    return picture;
}

}  // namespace

const std::string* latest(const FlightLog& log, std::size_t moment,
                          std::string MomentPictures::*part) {
    for (std::size_t i = moment + 1; i-- > 0;) {
        const std::string& file = log.moments[i].pictures.*part;
        if (!file.empty()) return &file;
    }
    return nullptr;
}

Picture greyPicture(const std::string& file) {
    return pictureOf(file, [](std::uint8_t level) { return greyColor(level / 255.); });
}

Picture obstaclePicture(const std::string& file) {
    return pictureOf(file, [](std::uint8_t level) {
        switch (static_cast<ObstacleLevel>(level)) {
            case ObstacleLevel::occupied:
                return kOccupied;
            case ObstacleLevel::tooNear:
                return kTooNear;
            case ObstacleLevel::free:
                return kFree;
            case ObstacleLevel::unseen:
                break;
        }
        return kUnseen;
    });
}

void LevelRange::add(const std::string& file) {
    const cv::Mat grey = decoded(file);
    for (int v = 0; v < grey.rows; ++v) {
        for (int u = 0; u < grey.cols; ++u) {
            const int level = grey.at<std::uint8_t>(v, u);
            if (level == kNoInformation) continue;
            least = std::min(least, level);
            largest = std::max(largest, level);
        }
    }
}

double LevelRange::traceOf(int level) {
    return std::pow(10., static_cast<double>(level) / kLevelsPerDecade);
}

Picture informationPicture(const std::string& file, const LevelRange& range) {
    const double span = std::max(1, range.largest - range.least);
    return pictureOf(file, [&](std::uint8_t level) {
        return level == kNoInformation ? kUnseen : viridis((level - range.least) / span);
    });
}

}  // namespace photonav
