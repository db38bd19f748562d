// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/sequence_euroc.hpp"

#include "euroc_dataset.hpp"

namespace photonav {
namespace {

using test::expectInputError;
using test::writeText;

class EurocSequence : public testing::Test {
  protected:
    EurocSequence() { dataset.write(folder.path()); }

    StereoSequence read() const { return readEurocSequence(folder.path().string()); }
    void expectRejected(const std::vector<std::string>& parts) const {
        expectInputError([&] { read(); }, parts);
    }
    /// Replaces what a sensor.yaml says.
    void change(int side, const std::string& from, const std::string& to) const {
        std::string text = dataset.sensor(side);
        ASSERT_NE(text.find(from), std::string::npos) << from;
        text.replace(text.find(from), from.size(), to);
        writeText(mav / fmt::format("cam{}/sensor.yaml", side), text);
    }
    std::string line(int i) const {
        return fmt::format("{0},{0}.png\n", test::WallDataset::nanoseconds(i));
    }

    test::WallDataset dataset{.width = 32, .height = 24};
    test::TemporaryFolder folder;
    test::fs::path mav = folder.path() / "mav0";
};

TEST_F(EurocSequence, ReadsCamerasImagesAndPoses) {
    const StereoSequence sequence = read();
    ASSERT_EQ(sequence.frames.size(), 5U);
    EXPECT_TRUE(sequence.skipped.empty());
    for (int side = 0; side < 2; ++side) {
        const DistortedCamera& camera = side == 0 ? sequence.left : sequence.right;
        const DistortedCamera expected = dataset.camera(side);
        EXPECT_EQ(camera.camera.width, 32U);
        EXPECT_EQ(camera.camera.fy(), expected.camera.fy());
        EXPECT_EQ(camera.distortion, expected.distortion);
        EXPECT_TRUE(camera.T_b_c.isApprox(expected.T_b_c, 1e-9));
    }
    EXPECT_EQ(sequence.groundtruthOf, "body");
    const auto& frame = sequence.frames[3];
    EXPECT_NEAR(frame.timestamp, dataset.time(3), 1e-6);
    ASSERT_TRUE(frame.hasPose);
    EXPECT_TRUE(frame.T_c_w.isApprox((dataset.T_w_b(3) * dataset.camera(0).T_b_c).inverse(), 1e-6));
    const StereoImages images = loadStereo(sequence, 3);
    EXPECT_EQ(images.left[7][9], dataset.image(0, 3).at<std::uint8_t>(7, 9));
    EXPECT_EQ(images.right[7][9], dataset.image(1, 3).at<std::uint8_t>(7, 9));
}

TEST_F(EurocSequence, TheGroundTruthMayBeOfTheLeftCameraOrAnySensor) {
    const Pose T_w_c = dataset.T_w_b(2);
    writeText(mav / "state_groundtruth_estimate0/sensor.yaml",
              "sensor_type: vicon\ncomment: poses of cam0, not of the body\n");
    EXPECT_EQ(read().groundtruthOf, "cam0");
    EXPECT_TRUE(read().frames[2].T_c_w.isApprox(T_w_c.inverse(), 1e-6));
    writeText(mav / "state_groundtruth_estimate0/sensor.yaml",
              "T_BS:\n  data: [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
    Pose T_b_s = Pose::Identity();
    T_b_s.translation().x() = 0.5;
    EXPECT_TRUE(read().frames[2].T_c_w.isApprox(
        (dataset.T_w_b(2) * T_b_s.inverse() * dataset.camera(0).T_b_c).inverse(), 1e-6));
    test::fs::remove_all(mav / "state_groundtruth_estimate0");
    EXPECT_EQ(read().groundtruthOf, "");
    EXPECT_FALSE(read().frames[2].hasPose);
}

TEST_F(EurocSequence, SkipsWhatHasNoPartnerOrGoesBackInTime) {
    writeText(mav / "cam0/data.csv",
              line(0) + line(2) + line(1) + line(2) + line(3) + line(4) + line(4));
    writeText(mav / "cam1/data.csv", line(0) + line(1) + line(2) + line(4));
    const StereoSequence sequence = read();
    ASSERT_EQ(sequence.frames.size(), 4U);
    EXPECT_NEAR(sequence.frames[1].timestamp, dataset.time(1), 1e-6);
    EXPECT_EQ(sequence.frames[1].leftFile.substr(sequence.frames[1].leftFile.size() - 10),
              sequence.frames[1].rightFile.substr(sequence.frames[1].rightFile.size() - 10));
    ASSERT_EQ(sequence.skipped.size(), 3U);
    EXPECT_EQ(sequence.skipped[0].reason, "line 2: timestamp is larger than the one after");
    EXPECT_EQ(sequence.skipped[1].reason, "line 7: timestamp repeats the one before");
    EXPECT_EQ(sequence.skipped[2].reason, "no image of cam1 within 0.002 s");
}

TEST_F(EurocSequence, RejectsMissingCameras) {
    expectInputError([] { readEurocSequence("/nowhere"); }, {"/nowhere", "no such folder"});
    test::fs::rename(mav / "cam1", mav / "other");
    expectRejected({"mav0/cam1", "no such folder", "cam0 and cam1"});
}

TEST_F(EurocSequence, RejectsOtherCameraAndDistortionModels) {
    change(1, "distortion_model: radial-tangential", "distortion_model: equidistant");
    expectRejected({"cam1/sensor.yaml", "distortion_model", "'equidistant'", "radial-tangential"});
    change(1, "camera_model: pinhole", "camera_model: omni");
    expectRejected({"cam1/sensor.yaml", "camera_model", "'omni'"});
    change(1, "intrinsics: [", "intrinsics: [1, ");
    expectRejected({"cam1/sensor.yaml", "intrinsics"});
    change(1, "T_BS:", "T_SB:");
    expectRejected({"cam1/sensor.yaml", "T_BS.data", "missing"});
    change(1, "data: [", "data: [3, ");
    expectRejected({"cam1/sensor.yaml", "T_BS.data"});
}

TEST_F(EurocSequence, RejectsTablesThatCannotBeUsed) {
    writeText(mav / "state_groundtruth_estimate0/data.csv", "1,0,0,0,1,0,0,0\n2,0,0,0,1,0,0,0\n");
    expectRejected(
        {"state_groundtruth_estimate0/data.csv", "no pose within 0.02 s", "1403715276.8"});
    writeText(mav / "state_groundtruth_estimate0/data.csv", "1,0,0,0,x,0,0,0\n");
    expectRejected({"data.csv", "line 1", "'x' is not a number"});
    for (const char* row : {"1,0,x,0,1,0,0,0\n", "1,0,0,x,1,0,0,0\n"}) {  // inside the position
        writeText(mav / "state_groundtruth_estimate0/data.csv", row);
        expectRejected({"data.csv", "line 1", "'x' is not a number"});
    }
    writeText(mav / "state_groundtruth_estimate0/data.csv", "1,1e308,0,0,1,0,0,0\n");
    expectRejected({"data.csv", "line 1", "position 1e+308 m from the origin"});
    writeText(mav / "state_groundtruth_estimate0/data.csv", "1,0,0\n");
    expectRejected({"data.csv", "line 1", "expected 8 fields, found 3"});
    writeText(mav / "cam1/data.csv", "17,17.png\n");
    expectRejected({"cam1/data.csv", "no image within 0.002 s"});
    writeText(mav / "cam1/data.csv", "#nothing\n");
    expectRejected({"cam1/data.csv", "no images"});
}

TEST_F(EurocSequence, RejectsDamagedImages) {
    const StereoSequence sequence = read();
    test::fs::resize_file(sequence.frames[1].rightFile, 40);
    expectInputError([&] { loadStereo(sequence, 1); }, {"cam1/data", "damaged"});
    test::fs::remove(sequence.frames[2].leftFile);
    expectInputError([&] { loadStereo(sequence, 2); }, {"cam0/data", "no such file"});
    cv::imwrite(sequence.frames[3].leftFile, cv::Mat(10, 10, CV_8UC1, cv::Scalar(3)));
    expectInputError([&] { loadStereo(sequence, 3); }, {"10x10", "32x24"});
}

}  // namespace
}  // namespace photonav
