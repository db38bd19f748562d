// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/sequence_tum.hpp"

#include "tum_dataset.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;
using test::expectInputError;
using test::writeText;

class TumSequence : public testing::Test {
  protected:
    TumSequence() { dataset.write(path); }

    Sequence read(const TumOptions& options = {}) const {
        return readTumSequence(path.string(), options);
    }
    void expectRejected(const std::vector<std::string>& parts) const {
        expectInputError([&] { read(); }, parts);
    }
    void expectFrameRejected(const std::vector<std::string>& parts) const {
        const Sequence sequence = read();
        expectInputError([&] { loadFrame(sequence, 0); }, parts);
    }

    test::TemporaryFolder folder;
    const test::fs::path& path = folder.path();
    test::FloorDataset dataset;
};

TEST_F(TumSequence, ReadsWhatWasRecorded) {
    const Sequence sequence = read();
    ASSERT_EQ(sequence.frames.size(), 6U);
    EXPECT_TRUE(sequence.skipped.empty());
    EXPECT_FALSE(sequence.cameraAssumed);
    EXPECT_EQ(sequence.camera.fx(), 60.);
    const RecordedFrame frame = loadFrame(sequence, 3);
    EXPECT_NEAR(frame.timestamp, 100.3, 1e-9);
    EXPECT_TRUE(frame.T_c_w.isApprox(dataset.T_w_c(3).inverse(), 1e-6));
    ASSERT_EQ(frame.view.intensity.getWidth(), 80U);
    ASSERT_EQ(frame.view.depth.getHeight(), 60U);
    EXPECT_FLOAT_EQ(frame.view.depth[10][20], 1.5F);
    // Every pixel shows the floor where its depth and pose say.
    const Vector3d p_c =
        frame.view.depth[10][20] * Vector3d((20 - 39.5) / 60., (10 - 29.5) / 60., 1.);
    const Vector3d p_w = frame.T_c_w.inverse() * p_c;
    EXPECT_NEAR(frame.view.intensity[10][20], test::floorTexture(p_w.x(), p_w.y()), 0.005);
}

TEST_F(TumSequence, ColourImagesBecomeGrey) {
    cv::imwrite((path / "rgb/0.png").string(), cv::Mat(60, 80, CV_8UC3, cv::Scalar(200, 100, 50)));
    const RecordedFrame frame = loadFrame(read(), 0);
    EXPECT_NEAR(frame.view.intensity[5][5], (0.114 * 200 + 0.587 * 100 + 0.299 * 50) / 255., 0.003);
}

TEST_F(TumSequence, DepthScaleComesFromOptionCameraFileOrStandard) {
    EXPECT_EQ(read().depthScale, 5000.);
    std::ofstream(path / "camera.yaml", std::ios::app) << "depth_scale: 1000\n";
    EXPECT_FLOAT_EQ(loadFrame(read(), 0).view.depth[0][0], 7.5F);
    EXPECT_EQ(read({.depthScale = 2500.}).depthScale, 2500.);
}

TEST_F(TumSequence, TheCameraFileMayGiveTheInformationScale) {
    EXPECT_FALSE(read().informationScale);
    std::ofstream(path / "camera.yaml", std::ios::app) << "information_scale: 0.08\n";
    EXPECT_EQ(read().informationScale, 0.08);
}

TEST_F(TumSequence, UnregisteredDepthIsLookedUpAlongTheSameRay) {
    cv::Mat depth(60, 80, CV_16UC1);
    for (int v = 0; v < 60; ++v) {
        for (int u = 0; u < 80; ++u) depth.at<std::uint16_t>(v, u) = 5000 + 100 * v + u;
    }
    cv::imwrite((path / "depth/0.png").string(), depth);
    const std::string camera = (path / "other.yaml").string();
    writeText(camera,
              "width: 80\nheight: 60\nfx: 40\nfy: 40\ncx: 39\ncy: 29\n"
              "depth_camera: {fx: 60, fy: 80, cx: 39, cy: 30}\n");
    const View view = loadFrame(read({.cameraFile = camera}), 0).view;
    // u = 59 is the ray x = 0.5, v = 19 the ray y = -0.25.
    EXPECT_NEAR(view.depth[19][59], (5000 + 100 * 10 + 69) / 5000., 1e-5);
    EXPECT_EQ(view.depth[0][40], 0.F);  // above the depth image
    EXPECT_EQ(view.depth[29][79], 0.F);
}

TEST_F(TumSequence, PosesMayBeThoseOfTheDepthCamera) {
    const std::string camera = "width: 80\nheight: 60\nfx: 60\nfy: 60\ncx: 39.5\ncy: 29.5\n";
    const std::string depthCamera =
        "depth_camera: {fx: 60, fy: 60, cx: 39.5, cy: 29.5, "
        "T_colour_depth: [-0.02, 0.01, 0, 0, 0, 0.6, 0.8]";
    writeText(path / "camera.yaml", camera + depthCamera + "}\n");
    const Sequence ofColour = read();
    writeText(path / "camera.yaml", camera + depthCamera + ", poses: depth}\n");
    const Sequence ofDepth = read();
    const Pose T_c_d = ofDepth.depthCamera->T_c_d;
    EXPECT_TRUE(T_c_d.translation().isApprox(Eigen::Vector3d(-0.02, 0.01, 0.)));
    EXPECT_NEAR(T_c_d.linear()(0, 1), -0.96, 1e-12);
    EXPECT_TRUE(ofDepth.frames[1].T_c_w.isApprox(T_c_d * ofColour.frames[1].T_c_w, 1e-12));
}

TEST_F(TumSequence, DepthImagesMayHaveASizeOfTheirOwn) {
    cv::imwrite((path / "depth/0.png").string(), cv::Mat(30, 40, CV_16UC1, 5000.));
    const std::string colour = "width: 80\nheight: 60\nfx: 60\nfy: 60\ncx: 39.5\ncy: 29.5\n";
    writeText(
        path / "camera.yaml",
        colour + "depth_camera: {width: 40, height: 30, fx: 30, fy: 30, cx: 19.5, cy: 14.5}\n");
    const View view = loadFrame(read(), 0).view;
    EXPECT_EQ(view.depth.getWidth(), 80U);
    EXPECT_NEAR(view.depth[30][40], 1., 1e-6);
    EXPECT_EQ(loadDepth(read(), 0).getWidth(), 40U);
    writeText(
        path / "camera.yaml",
        colour + "depth_camera: {width: 41, height: 30, fx: 30, fy: 30, cx: 19.5, cy: 14.5}\n");
    expectInputError([&] { loadFrame(read(), 0); }, {"40x30", "41x30", "depth_camera"});
}

TEST_F(TumSequence, WithoutCameraFileTheBenchmarksKinectIsAssumed) {
    test::fs::remove(path / "camera.yaml");
    const Sequence sequence = read();
    EXPECT_TRUE(sequence.cameraAssumed);
    EXPECT_EQ(sequence.camera.width, 640U);
    EXPECT_EQ(sequence.camera.cx(), 319.5);
    expectInputError([&] { loadFrame(sequence, 0); }, {"80x60", "640x480"});
}

TEST_F(TumSequence, DepthImagesAreUsedOnceByTheClosest) {
    writeText(path / "rgb.txt", "100.00 rgb/0.png\n100.01 rgb/1.png\n100.03 rgb/2.png\n");
    writeText(path / "depth.txt", "100.008 depth/0.png\n100.049 depth/1.png\n");
    const Sequence sequence = read();
    ASSERT_EQ(sequence.frames.size(), 2U);
    EXPECT_NE(sequence.frames[0].colourFile.find("rgb/1.png"), std::string::npos);
    EXPECT_NE(sequence.frames[1].colourFile.find("rgb/2.png"), std::string::npos);
    ASSERT_EQ(sequence.skipped.size(), 1U);
    EXPECT_NE(sequence.skipped[0].file.find("rgb/0.png"), std::string::npos);
    EXPECT_EQ(read({.tolerance = 0.015}).frames.size(), 1U);
}

TEST_F(TumSequence, AssociationFileIsTakenAsItIs) {
    writeText(path / "assoc.txt", "100.2 rgb/2.png 117 depth/0.png\n");
    Sequence sequence = read();
    ASSERT_EQ(sequence.frames.size(), 1U);
    EXPECT_NE(sequence.frames[0].depthFile.find("depth/0.png"), std::string::npos);
    writeText(path / "assoc.txt", "117 depth/0.png 100.2 rgb/2.png\n");
    sequence = read();
    EXPECT_NE(sequence.frames[0].depthFile.find("depth/0.png"), std::string::npos);
    EXPECT_NEAR(sequence.frames[0].timestamp, 100.2, 1e-9);
}

TEST_F(TumSequence, FramesWithoutPoseAreSkippedWithAReason) {
    writeText(path / "groundtruth.txt", "100.0 0 0 0 0 0 0 1\n100.08 1 0 0 0 0 0 1\n");
    const Sequence sequence = read();
    ASSERT_EQ(sequence.frames.size(), 2U);  // the second one is 0.02 s past the last pose
    ASSERT_EQ(sequence.skipped.size(), 4U);
    EXPECT_EQ(sequence.skipped[0].reason, "no pose within 0.02 s");
}

TEST_F(TumSequence, RejectsMissingFiles) {
    expectInputError([] { readTumSequence("/nowhere"); }, {"/nowhere", "no such folder"});
    test::fs::create_directory(path / "empty");
    expectInputError([&] { readTumSequence((path / "empty").string()); }, {"empty"});
    for (const char* name : {"rgb.txt", "depth.txt", "groundtruth.txt"}) {
        test::fs::rename(path / name, path / "away");
        expectRejected({name, "no such file"});
        test::fs::rename(path / "away", path / name);
    }
    writeText(path / "rgb.txt", "# nothing\n");
    expectRejected({"rgb.txt", "no images"});
}

TEST_F(TumSequence, RejectsBadTables) {
    writeText(path / "groundtruth.txt", "100 0 0 nan 0 0 0 1\n");
    expectRejected({"groundtruth.txt", "line 1", "not a finite number"});
    writeText(path / "groundtruth.txt", "900 0 0 0 0 0 0 1\n");
    expectRejected({"groundtruth.txt", "no pose within 0.02 s of any image"});
    writeText(path / "depth.txt", "500 depth/0.png\n");
    expectRejected({"depth.txt", "no depth image within 0.02 s"});
    writeText(path / "depth.txt", "500 depth/0.png\n400 depth/1.png\n");
    expectRejected({"depth.txt", "line 2", "smaller"});
    writeText(path / "rgb.txt", "100 rgb/0.png extra\n");
    expectRejected({"rgb.txt", "line 1", "expected 2 fields, found 3"});
}

TEST_F(TumSequence, RejectsBadCameraFiles) {
    const std::string centre = "cx: 39.5\ncy: 29.5\n";
    const auto rejected = [&](const std::string& text, const std::vector<std::string>& parts) {
        writeText(path / "camera.yaml", text);
        expectRejected(parts);
    };
    rejected("width: 80\nheight: 60\nfx: 0\nfy: 60\n" + centre, {"camera.yaml", "fx"});
    rejected("width: 0\nheight: 60\nfx: 60\nfy: 60\n" + centre, {"camera.yaml", "width"});
    rejected("width: 100000\nheight: 60\nfx: 60\nfy: 60\n" + centre, {"camera.yaml", "width"});
    rejected("width: 80\nheight: 60\nfx: 60\n" + centre, {"camera.yaml", "fy", "missing"});
    rejected("width: 80\nheight: 60\nfx: 60\nfy: 60\nfz: 60\n" + centre, {"fz", "camera.yaml"});
    rejected("width: 80\nheight: 60\nfx: 60\nfy: 60\ndepth_scale: 0\n" + centre,
             {"camera.yaml", "depth_scale"});
    rejected("width: 80\nheight: 60\nfx: 1e-2\nfy: 60\n" + centre, {"camera.yaml", "fx"});
    rejected("width: 80\nheight: 60\nfx: 60\nfy: 60\ncx: 1e9\ncy: 30\n", {"camera.yaml", "cx"});
    rejected(
        "width: 80\nheight: 60\nfx: 60\nfy: 60\ndepth_camera: {fx: 1, fy: 1, cx: 0}\n" + centre,
        {"camera.yaml", "depth_camera.cy", "missing"});
    expectInputError([&] { read({.cameraFile = "/nowhere.yaml"}); }, {"/nowhere.yaml"});
}

TEST_F(TumSequence, RejectsBadImages) {
    const auto copy = test::fs::copy_options::overwrite_existing;
    cv::imwrite((path / "depth/0.png").string(), cv::Mat(30, 40, CV_16UC1, cv::Scalar(1)));
    expectFrameRejected({"depth/0.png", "40x30", "80x60"});
    cv::imwrite((path / "depth/0.png").string(), cv::Mat(60, 80, CV_8UC1, cv::Scalar(1)));
    expectFrameRejected({"depth/0.png", "16 bits"});
    const RecordedFrame frame = loadFrame(read({.needsDepth = false}), 0);
    EXPECT_EQ(frame.view.depth.getSize(), 4800U);
    EXPECT_EQ(frame.view.depth.getMaxValue(), 0.F);
    test::fs::copy_file(path / "depth/1.png", path / "depth/0.png", copy);
    test::fs::resize_file(path / "rgb/0.png", test::fs::file_size(path / "rgb/0.png") / 2);
    expectFrameRejected({"rgb/0.png", "damaged"});
    writeText(path / "rgb/0.png", "");
    expectFrameRejected({"rgb/0.png", "damaged"});
    test::fs::remove(path / "rgb/0.png");
    expectFrameRejected({"rgb/0.png", "no such file"});
}

TEST_F(TumSequence, RejectsATruncatedJpeg) {
    const auto file = path / "rgb/0.jpg";
    cv::Mat noise(60, 80, CV_8UC1);
    cv::randu(noise, 0, 256);
    cv::imwrite(file.string(), noise);
    writeText(path / "rgb.txt", "100 rgb/0.jpg\n");
    EXPECT_NO_THROW(loadFrame(read(), 0));
    test::fs::resize_file(file, test::fs::file_size(file) / 2);
    expectFrameRejected({"rgb/0.jpg", "damaged"});
}

TEST_F(TumSequence, ReadsARealRecording) {
    const char* data = std::getenv("PHOTONAV_DATA");
    const test::fs::path root =
        data != nullptr ? test::fs::path(data)
                        : test::fs::path(PHOTONAV_SOURCE_DIR).parent_path() / "shared" / "data";
    if (!test::fs::exists(root / "rgbd_office")) GTEST_SKIP() << "no recording in " << root;
    const Sequence sequence = readTumSequence((root / "rgbd_office").string());
    EXPECT_EQ(sequence.frames.size(), 240U);
    EXPECT_EQ(sequence.depthScale, 1000.);
    const RecordedFrame frame = loadFrame(sequence, 100);
    double valid = 0.;
    for (unsigned v = 0; v < 480; ++v) {
        for (unsigned u = 0; u < 640; ++u) valid += frame.view.depth[v][u] > 0.4F ? 1. : 0.;
    }
    EXPECT_GT(valid / (640. * 480.), 0.5);
}

TEST_F(TumSequence, ForgivingItKeepsFramesWithoutPose) {
    std::ofstream(path / "rgb.txt") << "100.0 rgb/0.png\n100.2 rgb/2.png\n100.1 rgb/1.png\n"
                                       "100.2 rgb/2.png\n1x0.3 rgb/3.png\n1000.3 rgb/3.png\n"
                                       "100.3 rgb/3.png\n100.3 rgb/3.png\n100.4 rgb/4.png\n";
    writeText(path / "groundtruth.txt", "100.0 0 0 1 0 0 0 1\n");
    const Sequence sequence = read({.forgiving = true});
    ASSERT_EQ(sequence.frames.size(), 5U);
    EXPECT_TRUE(sequence.frames[0].hasPose);
    EXPECT_FALSE(sequence.frames[1].hasPose);
    EXPECT_EQ(sequence.recorded, 9U);
    ASSERT_EQ(sequence.skipped.size(), 4U);
    EXPECT_EQ(sequence.skipped[0].file, (path / "rgb.txt").string());
    EXPECT_NE(sequence.skipped[0].reason.find("line 5"), std::string::npos);
    EXPECT_EQ(sequence.skipped[1].reason, "line 2: timestamp is larger than the one after");
    EXPECT_EQ(sequence.skipped[2].reason, "line 6: timestamp is larger than the one after");
    EXPECT_EQ(sequence.skipped[3].reason, "line 8: timestamp repeats the one before");
    test::fs::remove(path / "groundtruth.txt");
    EXPECT_EQ(read({.forgiving = true}).frames.size(), 5U);
    expectInputError([&] { read(); }, {"rgb.txt", "line 5", "not a number"});
}

TEST_F(TumSequence, ForgivingItRejectsPosesOfAnotherTime) {
    writeText(path / "groundtruth.txt", "5 0 0 1 0 0 0 1\n6.5 0 0 1 0 0 0 1\n");
    expectInputError([&] { read({.forgiving = true}); },
                     {"groundtruth.txt", "from 5.000 to 6.500 s", "from 100.000 to 100.500 s"});
}

}  // namespace
}  // namespace photonav
