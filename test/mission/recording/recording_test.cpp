// SPDX-License-Identifier: BSD-3-Clause
#include "recording/recording.hpp"

#include <gtest/gtest.h>

#include "dataset/colmap_model.hpp"
#include "reason_of.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

class ColmapRecording : public testing::Test {
  protected:
    void SetUp() override {
        flight_.write(folder_.path() / "tum");
        fs::rename(folder_.path() / "tum/rgb", folder_.path() / "images");
        const double centre = 0.5 * (flight_.width - 1.), middle = 0.5 * (flight_.height - 1.);
        const Camera camera{
            flight_.width, flight_.height, {flight_.focal, flight_.focal, centre, middle}};
        std::vector<ColmapImage> images;
        for (int i = flight_.frames - 1; i >= 0; --i) {  // COLMAP keeps no order
            const Pose lying(Eigen::AngleAxisd(-EIGEN_PI / 2., Eigen::Vector3d::UnitX()));
            images.push_back({fmt::format("{}.png", i), (lying * flight_.T_w_c(i)).inverse()});
        }
        writeColmapModel(folder_.path().string(), camera, images);
        options_.dataset = folder_.path().string();
        options_.needsDepth = false;
        options_.up = "y";
    }
    void expectReason(const std::string& words) const {
        const std::string reason = test::reasonOf([&] { readRecording(options_); });
        EXPECT_NE(reason.find(words), std::string::npos) << reason;
    }

    test::TemporaryFolder folder_;
    test::FloorDataset flight_;
    RecordingOptions options_;
};

/// An image of 48 million pixels takes a second to read.
TEST(DepthRecording, IsStoppedBetweenTheImagesOfAFrame) {
    const test::TemporaryFolder folder;
    test::FloorDataset().write(folder.path());
    bool isStopped = false;
    RecordingOptions options;
    options.dataset = folder.path().string();
    options.isStopped = [&] { return isStopped; };
    const Recording recording = readRecording(options);
    EXPECT_GT(recording.load(1).view.depth.getSize(), 0U);
    isStopped = true;
    EXPECT_THROW(recording.load(1), Interrupted);
}

TEST_F(ColmapRecording, HasItsImagesInAnUprightWorld) {
    const Recording recording = readRecording(options_);
    EXPECT_EQ(recording.layout, "COLMAP");
    ASSERT_EQ(recording.sequence.frames.size(), 6U);
    const RecordedFrame last = recording.load(5);
    const Eigen::Vector3d lens = last.T_c_w.inverse().translation();
    EXPECT_NEAR(lens.z(), flight_.T_w_c(5).translation().z(), 1e-6);
    EXPECT_EQ(last.view.intensity.getWidth(), flight_.width);
    EXPECT_EQ(last.view.depth[10][10], 0.F);
}

TEST_F(ColmapRecording, RefusesWhatNeedsDepthAndOptionsOfOtherLayouts) {
    options_.stereo = "bm";
    expectReason("--stereo: does not apply to a COLMAP model");
    options_.stereo.clear();
    options_.depthScale = 1000.;
    expectReason("--depth-scale: does not apply");
    options_.depthScale.reset();
    options_.cameraFile = "camera.yaml";
    expectReason("--camera: does not apply");
    options_.cameraFile.clear();
    options_.needsDepth = true;
    expectReason("a COLMAP model has no depth images");
}

TEST_F(ColmapRecording, OfTumIsReadAsTum) {
    flight_.write(folder_.path());
    EXPECT_EQ(readRecording(options_).layout, "TUM RGB-D");
}

}  // namespace
}  // namespace photonav
