// SPDX-License-Identifier: BSD-3-Clause
#include "replay/depth_registration.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "dataset/camera_file.hpp"
#include "dataset/sequence_tum.hpp"
#include "geometry/se3.hpp"
#include "temporary_folder.hpp"
#include "tracking/rooms.hpp"
#include "tum_dataset.hpp"

namespace photonav::test {
namespace {

/// A flight past two crates in a room; the depth camera is beside the colour camera.
class UnregisteredDepth : public testing::Test {
  protected:
    static constexpr int kFrames = 16;

    static Camera colourCamera() { return makeCamera(240, 180, 1.1); }
    static Pose T_colour_depth() {
        Vector6 xi;
        xi << -0.025, 0.004, 0.006, 0.012, -0.015, 0.008;
        return expSE3(xi);
    }

    void SetUp() override {
        fs::create_directories(folder_.path() / "rgb");
        fs::create_directories(folder_.path() / "depth");
        std::string rgb, depth;
        for (int i = 0; i < kFrames; ++i) {
            const Pose T_c_w =
                lookFrom({1.5, 1.2 + 0.2 * i, 1.6 + 0.05 * (i % 3)}, 0.5, 0.1 * i - 0.4);
            writeImages(i, T_c_w);
            rgb += fmt::format("{} rgb/{}.png\n", 0.1 * i, i);
            depth += fmt::format("{} depth/{}.png\n", 0.1 * i, i);
        }
        writeText(folder_.path() / "rgb.txt", rgb);
        writeText(folder_.path() / "depth.txt", depth);
        Sequence cameras;
        cameras.camera = colourCamera();
        cameras.depthCamera = DepthCamera{depthCamera()};
        writeText(folder_.path() / "camera.yaml", cameraYaml(cameras));
    }
    static Camera depthCamera() { return makeCamera(200, 150, 1.2); }

    void writeImages(int i, const Pose& T_c_w) const {
        const View colour = photographed(room(), colourCamera(), T_c_w);
        View measured;
        room().render(depthCamera(), T_colour_depth().inverse() * T_c_w, measured);
        cv::Mat grey(180, 240, CV_8UC1), depth(150, 200, CV_16UC1);
        for (unsigned k = 0; k < colour.intensity.getSize(); ++k) {
            grey.data[k] = greyLevel(colour.intensity.bitmap[k]);
        }
        for (unsigned k = 0; k < measured.depth.getSize(); ++k) {
            depth.ptr<std::uint16_t>()[k] =
                static_cast<std::uint16_t>(std::lround(5000. * measured.depth.bitmap[k]));
        }
        const std::string name = std::to_string(i) + ".png";
        cv::imwrite((folder_.path() / "rgb" / name).string(), grey);
        cv::imwrite((folder_.path() / "depth" / name).string(), depth);
    }

    RecordingOptions options() const {
        RecordingOptions recording;
        recording.dataset = folder_.path().string();
        return recording;
    }

    TemporaryFolder folder_;
};

TEST_F(UnregisteredDepth, IsRegisteredByTheImages) {
    const DepthRegistration found = registerDepth(options());
    const Vector6 error = logSE3(T_colour_depth() * found.calibration.T_c_d.inverse());
    EXPECT_LT(error.head<3>().norm(), 0.006) << error.transpose();
    EXPECT_LT(error.tail<3>().norm(), 0.004) << error.transpose();
    const double nees = error.dot(found.calibration.covariance.ldlt().solve(error)) / 6.;
    EXPECT_LT(nees, 3.) << found.calibration.covariance.diagonal().cwiseSqrt().transpose();
    EXPECT_LT(found.calibration.residualAfter, 0.8 * found.calibration.residualBefore);
}

/// Intrinsics that are wrong displace a region of the image in all pairs alike: their scatter shows
/// nothing of it, that of the regions does.
TEST_F(UnregisteredDepth, IsLessCertainWithWrongIntrinsics) {
    Sequence wrong;
    wrong.camera = colourCamera();
    wrong.depthCamera = DepthCamera{makeCamera(200, 150, 1.26)};
    writeText(folder_.path() / "camera.yaml", cameraYaml(wrong));
    const DepthCalibration found = registerDepth(options()).calibration;
    const Vector6 error = logSE3(T_colour_depth() * found.T_c_d.inverse());
    EXPECT_LT(error.dot(found.covariance.ldlt().solve(error)) / 6., 3.);
}

TEST_F(UnregisteredDepth, CameraFileSaysWhereTheDepthCameraIs) {
    Sequence sequence = readTumSequence(options().dataset, {.forgiving = true});
    sequence.depthCamera->T_c_d = T_colour_depth();
    sequence.depthCamera->hasPoses = true;
    sequence.depthError = 0.02;
    sequence.blur = 0.5;
    const std::string file = (folder_.path() / "other.yaml").string();
    writeText(file, cameraYaml(sequence));
    const Sequence read =
        readTumSequence(options().dataset, {.cameraFile = file, .forgiving = true});
    ASSERT_TRUE(read.depthCamera);
    EXPECT_TRUE(read.depthCamera->T_c_d.isApprox(T_colour_depth(), 1e-5));
    EXPECT_TRUE(read.depthCamera->hasPoses);
    EXPECT_EQ(read.depthCamera->camera.width, 200U);
    EXPECT_EQ(read.depthCamera->camera.fx(), depthCamera().fx());
    EXPECT_EQ(read.depthError, 0.02);
    EXPECT_EQ(read.blur, 0.5);
}

TEST_F(UnregisteredDepth, NeedsMotion) {
    RecordingOptions few = options();
    few.frames = "0:6";
    expectInputError([&] { registerDepth(few); }, {few.dataset, "moves too little"});
}

}  // namespace
}  // namespace photonav::test
