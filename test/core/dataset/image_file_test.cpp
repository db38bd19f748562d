// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/image_file.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace photonav {
namespace {

TEST(GreyPng, KeepsValuesAndIsReduced) {
    const std::string png = greyPng(ImageF(40, 100, 0.4F), 50);
    const cv::Mat image =
        cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(image.size(), cv::Size(50, 20));
    EXPECT_EQ(image.type(), CV_8UC1);
    EXPECT_EQ(image.at<unsigned char>(10, 10), 102);
    EXPECT_THROW(greyPng(ImageF()), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
