// SPDX-License-Identifier: BSD-3-Clause
#include "io/image_bytes.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "dataset/sequence_tum.hpp"
#include "io/error.hpp"
#include "scene/texture.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

std::vector<std::uint8_t> encoded(const char* extension) {
    cv::Mat3b image(40, 50);
    cv::randu(image, 0, 255);
    std::vector<std::uint8_t> bytes;
    cv::imencode(extension, image, bytes);
    return bytes;
}

std::vector<std::uint8_t> sound(std::span<const std::uint8_t> image) {
    std::vector<std::uint8_t> rewritten;
    const auto bytes = soundImage(image, rewritten);
    return {bytes.begin(), bytes.end()};
}

TEST(ImageBytes, WhatIsWholeDecodesToTheSamePixels) {
    for (const char* extension : {".png", ".jpg", ".bmp"}) {
        const auto bytes = encoded(extension);
        const cv::Mat expected = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
        const cv::Mat image = cv::imdecode(sound(bytes), cv::IMREAD_UNCHANGED);
        EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0.) << extension;
    }
}

TEST(ImageBytes, NothingIsLeftOfWhatIsCutOrDamaged) {
    const auto png = encoded(".png");
    for (std::size_t length : {9UL, 20UL, png.size() / 2, png.size() - 1}) {
        EXPECT_TRUE(sound(std::span(png).first(length)).empty()) << length;
    }
    auto damaged = png;
    damaged[damaged.size() / 2] ^= 1;
    EXPECT_TRUE(sound(damaged).empty());
    const auto jpeg = encoded(".jpg");
    EXPECT_TRUE(sound(std::span(jpeg).first(jpeg.size() / 2)).empty());
    EXPECT_TRUE(sound({}).empty());
}

TEST(ImageBytes, SizesAreReadFromHeaders) {
    for (const char* extension : {".png", ".jpg", ".bmp", ".ppm"}) {
        const auto size = declaredSize(encoded(extension));
        ASSERT_TRUE(size) << extension;
        EXPECT_EQ(size->width, 50U) << extension;
        EXPECT_EQ(size->height, 40U) << extension;
    }
    auto marked = encoded(".jpg");
    marked.insert(marked.begin() + 2, {0xFF, 0x01, 0xFF, 0xD3});  // markers without a length
    ASSERT_TRUE(declaredSize(marked));
    EXPECT_EQ(declaredSize(marked)->width, 50U);
    const auto png = encoded(".png");
    EXPECT_FALSE(declaredSize(std::span(png).first(20)));
    EXPECT_FALSE(declaredSize({}));
}

TEST(ImageBytes, WhatIsTooLargeIsNotDecoded) {
    cv::Mat1b image(12000, 12000, std::uint8_t{0});
    std::vector<std::uint8_t> png;
    cv::imencode(".png", image, png);
    const std::string complaint = [&] {
        try {
            decodeGrey(png, "big.png");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    }();
    EXPECT_EQ(complaint, "big.png: 12000x12000 pixels: textures have at most 100 million");
}

/// Legal, of no use to us, and what libpng likes to comment on: gone before it is decoded.
TEST(ImageBytes, HeadersThatTheDecoderReadsInAnotherWayAreDamaged) {
    const std::string grey = "P5\n429496#65362P5)5\n0 1 4r_y\n89";
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(grey.data());
    try {
        decodeGrey({bytes, grey.size()}, "a.pgm");
        ADD_FAILURE() << "nothing was thrown";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "a.pgm: not an image, or damaged");
    }
}

TEST(ImageBytes, ChunksThatAreNoPictureAreLeftOut) {
    auto png = encoded(".png");
    const std::string chunk = std::string("\0\0\0\4tEXtphot", 12) + "\x2F\x72\x2E\x01";
    auto talkative = png;
    talkative.insert(talkative.begin() + 33, chunk.begin(), chunk.end());
    EXPECT_FALSE(sound(png).empty());
    EXPECT_EQ(sound(talkative), sound(png));
}

/// One line of ours, nothing by the libraries.
TEST(ImageBytes, DamagedFilesAreReportedByUsAlone) {
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "half.png").string();
    const auto png = encoded(".png");
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), std::ssize(png) / 2);
    testing::internal::CaptureStderr();
    test::expectInputError([&] { readGrey(file); }, {"half.png", "damaged"});
    test::expectInputError([&] { readGrey(file + "x"); }, {"half.pngx", "no such file"});
    test::expectInputError([&] { decodeGrey(std::span(png).first(99), "inside"); }, {"inside"});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace photonav
