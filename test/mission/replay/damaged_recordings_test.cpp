// SPDX-License-Identifier: BSD-3-Clause
// Replays of recordings that are damaged, black, without depth, or of two cameras.
#include "euroc_dataset.hpp"
#include "mission/replay/replay_fixture.hpp"

namespace photonav {
namespace {

using nlohmann::json;
using test::expectInputError;
using test::FlightDataset;
using test::ReplayFixture;
using test::writeText;
namespace fs = std::filesystem;

TEST_F(ReplayFixture, LocalisesWithoutDepthImages) {
    fs::remove_all(data / "depth");
    expectRejected({"depth/0.png", "no such file"});
    fs::remove(data / "depth.txt");
    expectRejected({"depth.txt: no such file", "`replay --map`"});
    useMap();
    const json result = run();
    EXPECT_EQ(result["tracked"], 12);
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 2e-3);
    EXPECT_TRUE(result["depth_density"].is_null());
    EXPECT_FALSE(Replay(options).medianDepth());
    options.up = "floor";
    expectRejected({"--up: floor", "the map's own is taken", "config.yaml"});
    options.up = "z";
    options.depthScale = 5000.;
    expectRejected({"--depth-scale", "no depth images"});
}

TEST_F(ReplayFixture, DamagedMissingAndBlackImagesAreSurvived) {
    fs::resize_file(data / "rgb/3.png", 100);
    fs::remove(data / "depth/5.png");
    blacken(7);
    blacken(8);
    for (const bool inMap : {false, true}) {
        if (inMap) useMap();
        const json result = run();
        EXPECT_FALSE(isLostForGood(replayed));
        const int unreadable = inMap ? 1 : 2;  // localisation needs no depth
        EXPECT_EQ(result["tracked"], 10 - unreadable);
        EXPECT_EQ(result["unreadable"], unreadable);
        EXPECT_EQ(result["lost"], 2);
        EXPECT_EQ(result["verdict"],
                  fmt::format("tracked {} of 12 frames, lost 2 (2 of them black), unreadable {}",
                              10 - unreadable, unreadable));
        ASSERT_EQ(result["lost_intervals"].size(), 1U);
        EXPECT_NEAR(result["lost_intervals"][0][0].get<double>(), FlightDataset::time(7), 1e-9);
        EXPECT_NEAR(result["lost_intervals"][0][1].get<double>(), FlightDataset::time(8), 1e-9);
        EXPECT_EQ(result["skipped"].size(), std::size_t(unreadable));
        EXPECT_LT(result["ate_rmse_m"].get<double>(), 5e-3);
    }
}

TEST_F(ReplayFixture, TimestampsThatRepeatOrGoBackAreReported) {
    writeText(data / "rgb.txt",
              "50.0 rgb/0.png\n50.1 rgb/1.png\n50.1 rgb/1.png\n50.0 rgb/0.png\n50.2 rgb/2.png\n"
              "50.3 rgb/3.png\n50.4 rgb/4.png\n50.9 rgb/9.png\n");
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_EQ(result["frames"], 6);
    EXPECT_EQ(result["skipped"].size(), 2U);
    ASSERT_EQ(result["gaps"].size(), 1U);
    EXPECT_NEAR(result["gaps"][0][1].get<double>(), 50.9, 1e-9);
    EXPECT_EQ(result["recorded"], 8);
}

TEST_F(ReplayFixture, RowsOfTheGroundTruthThatCannotBeUsedArePassedOver) {
    std::string poses = test::contentOf(data / "groundtruth.txt");
    const auto third = poses.find("50.3");
    poses.insert(third, "50.1 0 0 0 0 0 0 1\n50.25 0 0 nan 0 0 0 1\n");
    writeText(data / "groundtruth.txt", poses + "51.2 0.3 0");  // cut off
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_EQ(result["judged"], 12);
    EXPECT_EQ(result["recorded"], 12);
    ASSERT_EQ(result["skipped"].size(), 3U);
    std::string reasons;
    for (const json& row : result["skipped"]) reasons += row["reason"].get<std::string>();
    for (const char* part :
         {"line 4: timestamp is smaller", "line 5: 'nan'", "line 15: expected 8 fields, found 3"}) {
        EXPECT_NE(reasons.find(part), std::string::npos) << reasons;
    }
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 3e-3);
    writeText(data / "groundtruth.txt", "50 0 0 x 0 0 0 1\n");
    expectRejected({"groundtruth.txt: line 1: 'x' is not a number"});
}

TEST_F(ReplayFixture, ABlackRecordingIsLost) {
    for (int i = 0; i < flight.frames; ++i) blacken(i);
    json result = run();
    EXPECT_TRUE(isLostForGood(replayed));
    EXPECT_EQ(result["lost"], 12);
    EXPECT_EQ(result["verdict"], "lost at once: all 12 images are black");
    useMap();
    result = run();
    EXPECT_TRUE(isLostForGood(replayed));
    EXPECT_EQ(result["tracked"], 0);
    EXPECT_EQ(result["verdict"], "lost at once: all 12 images are black");
}

TEST_F(ReplayFixture, AMapIsNotGivenUpForBlackImages) {
    flight.frames = 24;
    flight.speed = 0.005;
    flight.write(data);
    for (int i = 0; i < 12; ++i) blacken(i);
    useMap();
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_EQ(result["tracked"], 12) << result["verdict"];
}

TEST_F(ReplayFixture, StereoRecordings) {
    test::WallDataset wall{.width = 320, .height = 240, .frames = 6};
    wall.write(folder.path() / "wall");
    options.dataset = (folder.path() / "wall").string();
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_EQ(result["tracked"], 6);
    const Replay replay(options);
    EXPECT_EQ(replay.recording().layout, "EuRoC");
    EXPECT_EQ(replay.recording().sequence.camera.width, 160U);
    EXPECT_EQ(replay.options().stereo, "bm");
    EXPECT_GT(result["depth_density"].get<double>(), 0.3);
    EXPECT_LT(result["depth_density"].get<double>(), 1.);
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 5e-3);
    const Pose expected = wall.T_w_b(2) * wall.camera(0).T_b_c;
    EXPECT_LT(
        (replayed.frames[2].truth_c_w->inverse().translation() - expected.translation()).norm(),
        1e-5);
    options.depthScale = 1000.;
    expectInputError([&] { run(); }, {"--depth-scale", "EuRoC"});
    options.depthScale.reset();
    options.up = "floor";
    expectInputError([&] { run(); }, {"--up: floor", "EuRoC"});
    options.up = "z";
    wall.width = 300;
    const auto cam1 = folder.path() / "wall/mav0/cam1";
    writeText(cam1 / "sensor.yaml", wall.sensor(1));
    expectInputError([&] { run(); }, {"cam1/sensor.yaml: resolution: 300x240", "320x240"});
    writeText(folder.path() / "wall/mav0/cam0/sensor.yaml", wall.sensor(0));
    expectInputError([&] { run(); },
                     {".png: 320x240 pixels", "300x240", "cam0/sensor.yaml (resolution)"});
    fs::remove_all(cam1);
    expectInputError([&] { run(); }, {"cam1", "no such folder"});
}

TEST_F(ReplayFixture, ABlackStereoRecordingIsLost) {
    const test::WallDataset wall{.width = 320, .height = 240, .frames = 4};
    wall.write(folder.path() / "wall");
    for (const char* camera : {"cam0", "cam1"}) {
        for (const auto& image :
             fs::directory_iterator(folder.path() / "wall/mav0" / camera / "data")) {
            cv::imwrite(image.path().string(), cv::Mat(240, 320, CV_8UC1, cv::Scalar(0)));
        }
    }
    options.dataset = (folder.path() / "wall").string();
    const json result = run();
    EXPECT_TRUE(isLostForGood(replayed));
    EXPECT_EQ(result["verdict"], "lost at once: all 4 images are black");
}

TEST_F(ReplayFixture, TheVerdictCountsImagesThatDoNotDetermineAllDirections) {
    run();
    replayed.frames[3].tracked.alignment.verdict = Verdict::degenerate;
    const json result = replayResult({}, replayed, evaluate(replayed));
    EXPECT_EQ(result["verdict"], "tracked 12 of 12 frames (1 degenerate)");
}

}  // namespace
}  // namespace photonav
