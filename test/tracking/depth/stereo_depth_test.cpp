// SPDX-License-Identifier: BSD-3-Clause
#include "depth/stereo_depth.hpp"

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
