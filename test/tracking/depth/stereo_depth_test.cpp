// SPDX-License-Identifier: BSD-3-Clause
#include "depth/stereo_depth.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "euroc_dataset.hpp"

namespace photonav {
namespace {

class StereoWall : public testing::Test {
  protected:
    StereoImages images(int i) const {
        StereoImages result;
        const auto copy = [](const cv::Mat& from, vpImage<unsigned char>& to) {
            to.resize(unsigned(from.rows), unsigned(from.cols));
            for (int v = 0; v < from.rows; ++v) {
                std::copy(from.ptr<std::uint8_t>(v), from.ptr<std::uint8_t>(v) + from.cols, to[v]);
            }
        };
        copy(wall.image(0, i), result.left);
        copy(wall.image(1, i), result.right);
        return result;
    }

    /// Share of the pixels with depth, and share of those that are right to one pixel of disparity.
    void expectDepths(const StereoOptions& options, double least) {
        StereoDepth stereo(wall.camera(0), wall.camera(1), options);
        View view;
        stereo(images(2), view);
        const Camera& camera = stereo.camera();
        ASSERT_EQ(view.depth.getWidth(), camera.width);
        EXPECT_NEAR(stereo.baseline(), wall.baseline, 1e-6);
        const Pose T_w_r = wall.T_w_b(2) * wall.camera(0).T_b_c * stereo.T_r_c().inverse();
        double found = 0., good = 0.;
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 0; u < camera.width; ++u) {
                const double z = view.depth[v][u];
                if (z == 0.) continue;
                const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(),
                                          (v - camera.cy()) / camera.fy(), 1.);
                const double fb = camera.fx() * stereo.baseline();
                ++found;
                good += std::abs(fb / z - fb / wall.depth(T_w_r, ray)) < 1. ? 1. : 0.;
            }
        }
        EXPECT_GT(found / double(view.depth.getSize()), least);
        EXPECT_GT(good / found, 0.97);
    }

    test::WallDataset wall{.width = 320, .height = 240};
};

TEST_F(StereoWall, BlockMatchingFindsItsDepthThroughDistortionAndTwist) {
    expectDepths({.halvings = 0, .minDepth = 1.2, .blockSize = 11}, 0.85);
}

/// An error of all disparities is one of the whole motion. OpenCV's block matching alone has errors
/// of 0.07 pixels in the median, and a mean of 0.03.
TEST_F(StereoWall, DisparitiesAreExactToAFewHundredthsOfAPixel) {
    StereoDepth stereo(wall.camera(0), wall.camera(1),
                       {.halvings = 0, .minDepth = 1.2, .blockSize = 11});
    const Camera& camera = stereo.camera();
    const double fb = camera.fx() * stereo.baseline();
    double sum = 0.;
    std::vector<double> errors;
    for (int i = 0; i < 3; ++i) {
        View view;
        stereo(images(i), view);
        const Pose T_w_r = wall.T_w_b(i) * wall.camera(0).T_b_c * stereo.T_r_c().inverse();
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(),
                                          (v - camera.cy()) / camera.fy(), 1.);
                const double error = fb / view.depth[v][u] - fb / wall.depth(T_w_r, ray);
                if (!(view.depth[v][u] > 0.F) || std::abs(error) > 0.5) continue;
                sum += error;
                errors.push_back(std::abs(error));
            }
        }
    }
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    EXPECT_NEAR(sum / static_cast<double>(errors.size()), 0., 0.01);
    EXPECT_LT(*middle, 0.03);
}

TEST_F(StereoWall, SemiGlobalMatchingFindsMore) {
    expectDepths(
        {.method = StereoMethod::semiGlobal, .halvings = 0, .minDepth = 1.2, .blockSize = 15}, 0.9);
}

TEST_F(StereoWall, AtHalfTheSizeAsWell) {
    expectDepths({.halvings = 1, .minDepth = 1.2, .blockSize = 9}, 0.8);
}

TEST_F(StereoWall, TheIntensityIsThatOfTheWall) {
    StereoDepth stereo(wall.camera(0), wall.camera(1), {.halvings = 0});
    View view;
    stereo(images(0), view);
    const Camera& camera = stereo.camera();
    const Pose T_w_r = wall.T_w_b(0) * wall.camera(0).T_b_c * stereo.T_r_c().inverse();
    double worst = 0.;
    for (unsigned v = 20; v < camera.height - 20; v += 7) {
        for (unsigned u = 20; u < camera.width - 20; u += 7) {
            const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(),
                                      (v - camera.cy()) / camera.fy(), 1.);
            const Eigen::Vector3d p_w = T_w_r * (wall.depth(T_w_r, ray) * ray);
            worst = std::max(worst,
                             std::abs(view.intensity[v][u] - test::wallTexture(p_w.y(), p_w.z())));
        }
    }
    EXPECT_LT(worst, 0.08);
}

TEST_F(StereoWall, SurfacesOutOfRangeAreLeftOut) {
    StereoDepth stereo(wall.camera(0), wall.camera(1),
                       {.halvings = 0, .minDepth = 1.2, .maxDepth = 1.5});
    View view;
    stereo(images(0), view);
    for (unsigned i = 0; i < view.depth.getSize(); ++i) EXPECT_LE(view.depth.bitmap[i], 1.5F);
}

/// OpenCV refuses blocks that are larger than the image.
TEST_F(StereoWall, BlocksAreNotLargerThanTheImages) {
    wall = {.width = 64, .height = 16};
    View view;
    for (const StereoMethod method : {StereoMethod::blockMatching, StereoMethod::semiGlobal}) {
        StereoDepth stereo(wall.camera(0), wall.camera(1),
                           {.method = method, .halvings = 0, .blockSize = 21});
        stereo(images(0), view);
        EXPECT_EQ(view.depth.getHeight(), 16U);
    }
    EXPECT_THROW(StereoDepth(wall.camera(0), wall.camera(1), {.halvings = 2}),
                 std::invalid_argument);
}

/// Blocks beside texture would match it, and seem to be as near. Noise alone has no depth.
TEST(Stereo, OnlyPixelsOnTextureHaveDepth) {
    const Camera camera = makeCamera(160, 60, 1.2);
    const DistortedCamera left{camera, Eigen::Vector4d::Zero(), Pose::Identity(), {}};
    DistortedCamera right = left;
    right.T_b_c.translation().x() = 0.1;
    constexpr unsigned kBegin = 70, kEnd = 110, kShift = 8;  // of the texture, in the left image
    StereoImages pair{{60, 160}, {60, 160}};
    std::mt19937 random(3);
    std::normal_distribution<double> noise(128., 5.);
    std::uniform_int_distribution<int> grey(0, 255);
    for (unsigned v = 0; v < 60; ++v) {
        for (unsigned u = 0; u < 160; ++u) {
            pair.left[v][u] = static_cast<unsigned char>(noise(random));
            pair.right[v][u] = static_cast<unsigned char>(noise(random));
        }
        for (unsigned u = kBegin; u < kEnd; ++u) {
            pair.right[v][u - kShift] = pair.left[v][u] = static_cast<unsigned char>(grey(random));
        }
    }
    const auto depths = [&](double ofNoise) {
        StereoDepth stereo(left, right,
                           {.halvings = 0, .blockSize = 21, .blur = 1., .noise = ofNoise});
        View view;
        stereo(pair, view);
        std::array<int, 2> found{};  // beside the texture, and on it
        for (unsigned v = 0; v < 60; ++v) {
            for (unsigned u = 0; u < 160; ++u) {
                const bool isOn = u + 2 >= kBegin && u < kEnd + 2;
                found[isOn ? 1 : 0] += view.depth[v][u] > 0.F ? 1 : 0;
            }
        }
        return found;
    };
    const auto all = depths(0.), onTexture = depths(5. / 255.);
    EXPECT_GT(all[0], 300);
    EXPECT_LT(onTexture[0], all[0] / 3);
    EXPECT_GT(onTexture[1], 0.9 * all[1]);
}

TEST_F(StereoWall, RejectsCamerasInTheWrongOrderAndImagesOfAnotherSize) {
    EXPECT_THROW(StereoDepth(wall.camera(1), wall.camera(0)), std::invalid_argument);
    StereoDepth stereo(wall.camera(0), wall.camera(1));
    StereoImages wrong = images(0);
    wrong.right.resize(100, 100);
    View view;
    EXPECT_THROW(stereo(wrong, view), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
