// SPDX-License-Identifier: BSD-3-Clause
#include "commands/replay_command.hpp"

#include "app/executable.hpp"
#include "app/recorded_flight.hpp"
#include "commands/map_command.hpp"
#include "euroc_dataset.hpp"
#include "recording/trajectory.hpp"
#include "report/replay_report.hpp"
#include "runs/replay_calibration.hpp"

namespace photonav {
namespace {

using nlohmann::json;
using test::expectInputError;
using test::Flight;
using test::kScene;
using test::writeText;

class ReplayCommand : public testing::Test {
  protected:
    ReplayCommand() {
        flight.write(data);
        writeText(folder.path() / "room.yaml", kScene);
        options.dataset = data.string();
        options.out = folder.path() / "out";
        options.odometry = true;
    }

    void useMap() {
        options.odometry = false;
        options.mapFile = (folder.path() / "room.yaml").string();
    }

    ReplayReport run() { return runReplay(options, running); }
    void expectRejected(const std::vector<std::string>& parts) {
        expectInputError([&] { run(); }, parts);
        EXPECT_FALSE(test::fs::exists(options.out / "result.json"));
    }
    void blacken(int i) const {
        cv::imwrite((data / fmt::format("rgb/{}.png", i)).string(),
                    cv::Mat(120, 160, CV_8UC1, cv::Scalar(0)));
    }
    std::vector<std::vector<double>> numbers(const char* name) const {
        std::vector<std::vector<double>> rows;
        std::ifstream in(options.out / name);
        for (std::string line; std::getline(in, line);) {
            if (line.starts_with('#')) continue;
            std::istringstream words(line);
            rows.emplace_back(std::istream_iterator<double>(words),
                              std::istream_iterator<double>());
        }
        return rows;
    }

    Flight flight;
    test::TemporaryFolder folder;
    test::fs::path data = folder.path() / "flight";
    ReplayOptions options;
    std::atomic<bool> running{false};
};

TEST_F(ReplayCommand, OdometryFollowsTheFlight) {
    std::size_t calls = 0;
    options.progress = [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(total, 12U);
    };
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(calls, 12U);
    const json& result = report.result;
    EXPECT_EQ(result["frames"], 12);
    EXPECT_EQ(result["tracked"], 12);
    EXPECT_EQ(result["lost"], 0);
    EXPECT_TRUE(result["lost_intervals"].empty());
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 3e-3);
    EXPECT_GE(result["ate_max_m"].get<double>(), result["ate_rmse_m"].get<double>());
    EXPECT_EQ(result["ate_alignment"], "SE(3), by the positions");
    EXPECT_EQ(result["rpe"]["frame"]["pairs"], 11);
    EXPECT_LT(result["rpe"]["frame"]["translation_m"].get<double>(), 2e-3);
    EXPECT_LT(result["rpe"]["second"]["rotation_deg"].get<double>(), 0.2);
    EXPECT_TRUE(result["rpe"]["metre"].is_null());  // 0.33 m flown
    EXPECT_TRUE(result["nees_per_dof"].is_number());
    EXPECT_GT(result["fps"].get<double>(), 0.);
}

TEST_F(ReplayCommand, OdometryAtTheWidthAskedFor) {
    const auto errorAt = [&](std::optional<int> maxWidth) {
        options.maxWidth = maxWidth;
        return run().result["ate_rmse_m"].get<double>();
    };
    const double byDefault = errorAt({});
    EXPECT_DOUBLE_EQ(errorAt(80), byDefault);  // half of the images' 160
    EXPECT_NE(errorAt(40), byDefault);
    EXPECT_LT(errorAt(160), 3e-3);
    EXPECT_NE(errorAt(160), byDefault);
}

TEST_F(ReplayCommand, WritesWhatOtherProgramsRead) {
    const ReplayReport report = run();
    for (const char* name : {"report.html", "errors.png", "strips.png", "top_view.png"}) {
        EXPECT_TRUE(test::fs::exists(options.out / name)) << name;
    }
    std::ifstream in(options.out / "result.json");
    EXPECT_EQ(json::parse(in), report.result);
    const Trajectory estimate = readTrajectory((options.out / "trajectory.tum").string());
    const Trajectory truth = readTrajectory((options.out / "groundtruth.tum").string());
    ASSERT_EQ(estimate.size(), 12U);
    ASSERT_EQ(truth.size(), 12U);
    EXPECT_TRUE(truth[5].T_w_c.isApprox(flight.T_w_c(5), 1e-5));
    EXPECT_TRUE(estimate[5].T_w_c.isApprox(flight.T_w_c(5), 5e-3));
    const auto covariances = numbers("trajectory.cov");
    const auto openVins = numbers("trajectory.ov");
    ASSERT_EQ(covariances.size(), 12U);
    ASSERT_EQ(openVins.size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(covariances[i].size(), 22U);
        ASSERT_EQ(openVins[i].size(), 20U);
        EXPECT_NEAR(openVins[i][0], covariances[i][0], 1e-9);
        EXPECT_NEAR(openVins[i][8], covariances[i][16], 1e-9);  // s44
    }
    std::ifstream csv(options.out / "frames.csv");
    int rows = 0;
    for (std::string line; std::getline(csv, line); ++rows) {
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 16) << line;
    }
    EXPECT_EQ(rows, 13);
}

TEST_F(ReplayCommand, LocalisesInAScene) {
    useMap();
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(report.result["tracked"], 12);
    EXPECT_EQ(report.result["ate_alignment"], "none");
    EXPECT_LT(report.result["ate_rmse_m"].get<double>(), 2e-3);
}

TEST_F(ReplayCommand, LocalisesInTheMapOfItsOwnFirstHalf) {
    MapOptions map;
    map.dataset = data.string();
    map.out = folder.path() / "map";
    map.resolution = 0.025;
    map.frames = ":6";
    runMap(map, running);
    options.odometry = false;
    options.mapFile = (map.out / "map.ot").string();
    options.frames = "4:10";
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(report.result["frames"], 6);
    EXPECT_EQ(report.result["tracked"], 6);
    EXPECT_LT(report.result["ate_rmse_m"].get<double>(), 0.02);
}

TEST_F(ReplayCommand, LocalisesInAMapMadeWithoutDepthImages) {
    Flight longer{.frames = 20};
    longer.write(data);
    MapOptions map;
    map.dataset = data.string();
    map.out = folder.path() / "map";
    map.depth = "monocular";
    map.fusion.minRange = 0.5;
    const MapReport made = runMap(map, running);
    const json& depth = made.result["monocular"];
    EXPECT_GE(depth["references"], 1);
    EXPECT_GT(depth["completeness"].get<double>(), 0.15);
    EXPECT_LT(depth["median_relative_error"].get<double>(), 0.03);
    EXPECT_LT(depth["share_above_10_percent"].get<double>(), 0.05);
    EXPECT_NEAR(depth["converged"].get<double>() + depth["given_up"].get<double>() +
                    depth["searching"].get<double>(),
                1., 1e-9);
    EXPECT_TRUE(test::fs::exists(map.out / "convergence.png"));
    options.odometry = false;
    options.mapFile = (map.out / "map.ot").string();
    options.minOverlap = 0.1;
    options.frames = "2:10";
    const ReplayReport report = run();
    EXPECT_EQ(report.result["tracked"], 8);
    EXPECT_LT(report.result["ate_rmse_m"].get<double>(), 0.08);
    map.depth = "sonar";
    expectInputError([&] { runMap(map, running); }, {"--depth", "'sonar'"});
}

TEST_F(ReplayCommand, LocalisesWithoutDepthImages) {
    test::fs::remove_all(data / "depth");
    expectRejected({"depth/0.png", "no such file"});
    test::fs::remove(data / "depth.txt");
    expectRejected({"depth.txt: no such file", "`replay --map`"});
    useMap();
    const json result = run().result;
    EXPECT_EQ(result["tracked"], 12);
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 2e-3);
    EXPECT_TRUE(result["depth_density"].is_null());
    EXPECT_TRUE(result["dataset"]["median_depth_m"].is_null());
    test::fs::remove(options.out / "result.json");
    options.up = "floor";
    expectRejected({"--up: floor", "no depth images"});
    options.up = "z";
    options.depthScale = 5000.;
    expectRejected({"--depth-scale", "no depth images"});
}

/// The sample flights in the scenes they were flown in, hovering at the goal included.
TEST_F(ReplayCommand, TheSampleFlightsAreTrackedInTheirScenes) {
    const std::string source = PHOTONAV_SOURCE_DIR;
    options.odometry = false;
    for (const auto& [name, scene] :
         {std::pair("flight_down", "two_textures"), std::pair("flight_front45", "room")}) {
        options.dataset = source + "/data/" + name;
        options.mapFile = source + "/config/scenes/" + scene + ".yaml";
        const json result = run().result;
        EXPECT_EQ(result["lost"], 0) << name;
        // 9 to 10.5 mm: a few images of almost nothing (sigma 35 mm) decide it.
        EXPECT_LT(result["ate_rmse_m"], 0.015) << name;
        EXPECT_GT(result["nees_per_dof"], 0.5) << name;
        EXPECT_LT(result["nees_per_dof"], 1.35) << name;
    }
}

TEST_F(ReplayCommand, CalibrationMakesCovariancesTrue) {
    Flight longer{.frames = 30, .speed = 0.02};
    longer.write(data);
    useMap();
    options.calibrate = true;
    const json result = run().result;
    EXPECT_GT(result["options"]["scale"], 0.);
    const json fitted = result["calibration"];
    EXPECT_GE(fitted["correlation_time"], 1.);
    EXPECT_NEAR(fitted["nees_after"].get<double>(), 1., 0.3);
    const Calibration read = readCalibration((options.out / "calibration.yaml").string(), false);
    EXPECT_NEAR(read.scale, fitted["scale"].get<double>(), 0.01 * read.scale);
    EXPECT_NEAR(read.floorTranslation, fitted["floor"][0].get<double>(), 1e-4);
    EXPECT_NEAR(read.floorRotation, fitted["floor"][1].get<double>(), 1e-4);
    options.frames = ":10";
    EXPECT_TRUE(run().result["calibration"].is_null());
}

ReplayedFrame trackedAt(double timestamp, double x, double trueX, double keyframe) {
    ReplayedFrame frame;
    frame.timestamp = timestamp;
    frame.status = FrameStatus::tracked;
    frame.tracked.T_c_w.mean.translation().x() = x;
    frame.tracked.keyframe = keyframe;
    frame.tracked.alignment.verdict = Verdict::converged;
    frame.tracked.alignment.information = Matrix6::Identity();
    frame.truth_c_w = Pose::Identity();
    frame.truth_c_w->translation().x() = trueX;
    return frame;
}

/// Odometry's errors are those of single alignments, to whichever keyframe.
TEST(AlignmentErrors, AreOfTheKeyframeAlignedTo) {
    ReplayRun run;
    run.frames = {trackedAt(1., 0., 0., 1.), trackedAt(2., 1.1, 1., 1.), trackedAt(3., 2.3, 2., 2.),
                  trackedAt(4., 3., 3., 1.)};
    run.frames[0].tracked.alignment.information.setZero();  // of its own keyframe
    const auto errors = alignmentErrors(run, true, 0.5);
    ASSERT_EQ(errors.size(), 3U);
    EXPECT_NEAR(errors[0].xi.x(), -0.1, 1e-12);
    EXPECT_NEAR(errors[1].xi.x(), -0.2, 1e-12);
    EXPECT_NEAR(errors[2].xi.x(), 0., 1e-12);
    EXPECT_TRUE(errors[0].information.isApprox(2. * Matrix6::Identity()));
    EXPECT_NEAR(alignmentErrors(run, false, 1.)[1].xi.x(), -0.3, 1e-12);
}

TEST_F(ReplayCommand, TheStartCanBeGiven) {
    useMap();
    test::fs::remove(data / "groundtruth.txt");
    expectRejected({"--start", "no ground truth"});
    options.up = "y";
    expectRejected({"--up", "no true poses"});
    options.up = "z";
    const Pose T_w_c = flight.T_w_c(0);
    const Eigen::Quaterniond q(T_w_c.linear());
    const auto& p = T_w_c.translation();
    options.start = fmt::format("{},{},{},{},{},{},{}", p.x() + 0.03, p.y(), p.z() - 0.02, q.x(),
                                q.y(), q.z(), q.w());
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_TRUE(report.result["ate_rmse_m"].is_null());
    EXPECT_TRUE(report.result["nees_per_dof"].is_null());
    EXPECT_FALSE(test::fs::exists(options.out / "groundtruth.tum"));
    const Trajectory estimate = readTrajectory((options.out / "trajectory.tum").string());
    EXPECT_TRUE(estimate[8].T_w_c.isApprox(flight.T_w_c(8), 5e-3));
}

TEST_F(ReplayCommand, InTheMapOfAnotherRoomItIsLostAtOnce) {
    useMap();
    std::string other = kScene;
    other.replace(other.find("seed: 4"), 7, "seed: 9");
    writeText(folder.path() / "room.yaml", other);
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.result["tracked"], 0);
    EXPECT_EQ(report.result["lost"], 10);
    const auto verdict = report.result["verdict"].get<std::string>();
    EXPECT_TRUE(verdict.starts_with("lost at once")) << verdict;
    EXPECT_NE(verdict.find("must share a world (--up, --start)"), std::string::npos) << verdict;
    EXPECT_EQ(verdict.find("--min-overlap"), std::string::npos) << verdict;
    EXPECT_TRUE(test::fs::exists(options.out / "report.html"));
}

TEST_F(ReplayCommand, LostForTooLittleOverlapItNamesTheOption) {
    useMap();
    options.minOverlap = 0.5;
    std::string small = kScene;  // a floor that fills a small part of the images
    small.replace(small.find("u: [6, 0, 0], v: [0, 6, 0]"), 26, "u: [2.7, 0, 0], v: [0, 3, 0]");
    writeText(folder.path() / "room.yaml", small);
    const auto verdict = run().result["verdict"].get<std::string>();
    EXPECT_NE(verdict.find("overlap 0."), std::string::npos) << verdict;
    EXPECT_NE(verdict.find("--min-overlap"), std::string::npos) << verdict;
}

TEST_F(ReplayCommand, ItsConfigRepeatsTheRun) {
    useMap();
    options.frames = "1:9";
    options.every = 2;
    options.startSigma = 0.02;
    options.floorTranslation = 0.003;
    options.maxWidth = 80;
    options.calibrate = true;
    json first = run().result;
    const auto textOf = [](const test::fs::path& file) {
        std::ostringstream text;
        text << std::ifstream(file).rdbuf();
        return text.str();
    };
    const auto again = folder.path() / "again";
    const std::string config = (options.out / "config.yaml").string();
    const Execution good = photonav(fmt::format("replay {} --out {}", config, again.string()));
    ASSERT_EQ(good.exitCode, 0) << good.output;
    json second = json::parse(textOf(again / "result.json"));
    EXPECT_EQ(second["options"]["floor"][0], 0.003);
    EXPECT_EQ(second["options"]["max_width"], 80);
    for (const char* key : {"time", "fps", "fps_with_reading", "options"}) {
        first.erase(key);
        second.erase(key);
    }
    EXPECT_EQ(first, second);
    EXPECT_EQ(textOf(again / "config.yaml"), textOf(config));
    const auto expectRefused = [&](const std::string& arguments, const std::string& reason) {
        const Execution run = photonav("replay " + arguments);
        EXPECT_EQ(run.exitCode, 2);
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
    };
    expectRefused(config + " --every 3", "--every: not together with a config; edit ");
    writeText(folder.path() / "bad.yaml", textOf(config) + "minoverlap: 0.1\n");
    expectRefused((folder.path() / "bad.yaml").string(),
                  "minoverlap: unknown key, did you mean 'min_overlap'");
    writeText(folder.path() / "bad.yaml", "odometry: true\n");
    expectRefused((folder.path() / "bad.yaml").string(), "dataset: missing");
}

TEST_F(ReplayCommand, DamagedMissingAndBlackImagesAreSurvived) {
    test::fs::resize_file(data / "rgb/3.png", 100);
    test::fs::remove(data / "depth/5.png");
    blacken(7);
    blacken(8);
    for (const bool inMap : {false, true}) {
        if (inMap) useMap();
        const ReplayReport report = run();
        EXPECT_EQ(report.exitCode, 0);
        const int unreadable = inMap ? 1 : 2;  // localisation needs no depth
        EXPECT_EQ(report.result["tracked"], 10 - unreadable);
        EXPECT_EQ(report.result["unreadable"], unreadable);
        EXPECT_EQ(report.result["lost"], 2);
        EXPECT_EQ(report.result["verdict"],
                  fmt::format("tracked {} of 12 frames, lost 2 (2 of them black), unreadable {}",
                              10 - unreadable, unreadable));
        ASSERT_EQ(report.result["lost_intervals"].size(), 1U);
        EXPECT_NEAR(report.result["lost_intervals"][0][0].get<double>(), Flight::time(7), 1e-9);
        EXPECT_NEAR(report.result["lost_intervals"][0][1].get<double>(), Flight::time(8), 1e-9);
        EXPECT_EQ(report.result["skipped"].size(), std::size_t(unreadable));
        EXPECT_LT(report.result["ate_rmse_m"].get<double>(), 5e-3);
    }
}

TEST_F(ReplayCommand, TimestampsThatRepeatOrGoBackAreReported) {
    writeText(data / "rgb.txt",
              "50.0 rgb/0.png\n50.1 rgb/1.png\n50.1 rgb/1.png\n50.0 rgb/0.png\n50.2 rgb/2.png\n"
              "50.3 rgb/3.png\n50.4 rgb/4.png\n50.9 rgb/9.png\n");
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(report.result["frames"], 6);
    EXPECT_EQ(report.result["skipped"].size(), 2U);
    ASSERT_EQ(report.result["gaps"].size(), 1U);
    EXPECT_NEAR(report.result["gaps"][0][1].get<double>(), 50.9, 1e-9);
    EXPECT_EQ(report.result["recorded"], 8);
}

TEST_F(ReplayCommand, RowsOfTheGroundTruthThatCannotBeUsedArePassedOver) {
    std::string poses = test::contentOf(data / "groundtruth.txt");
    const auto third = poses.find("50.3");
    poses.insert(third, "50.1 0 0 0 0 0 0 1\n50.25 0 0 nan 0 0 0 1\n");
    writeText(data / "groundtruth.txt", poses + "51.2 0.3 0");  // cut off
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(report.result["judged"], 12);
    EXPECT_EQ(report.result["recorded"], 12);
    ASSERT_EQ(report.result["skipped"].size(), 3U);
    std::string reasons;
    for (const json& row : report.result["skipped"]) reasons += row["reason"].get<std::string>();
    for (const char* part :
         {"line 4: timestamp is smaller", "line 5: 'nan'", "line 15: expected 8 fields, found 3"}) {
        EXPECT_NE(reasons.find(part), std::string::npos) << reasons;
    }
    EXPECT_LT(report.result["ate_rmse_m"].get<double>(), 3e-3);
    writeText(data / "groundtruth.txt", "50 0 0 x 0 0 0 1\n");
    options.out = folder.path() / "refused";
    expectRejected({"groundtruth.txt: line 1: 'x' is not a number"});
}

TEST_F(ReplayCommand, ABlackRecordingIsLost) {
    for (int i = 0; i < flight.frames; ++i) blacken(i);
    ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.result["lost"], 12);
    EXPECT_EQ(report.result["verdict"], "lost at once: all 12 images are black");
    useMap();
    report = run();
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.result["tracked"], 0);
    EXPECT_EQ(report.result["verdict"], "lost at once: all 12 images are black");
}

TEST_F(ReplayCommand, AMapIsNotGivenUpForBlackImages) {
    flight.frames = 24;
    flight.speed = 0.005;
    flight.write(data);
    for (int i = 0; i < 12; ++i) blacken(i);
    useMap();
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(report.result["tracked"], 12) << report.result["verdict"];
}

/// What it begins with is nowhere near the truth, and must not count.
TEST_F(ReplayCommand, OdometryIsLaidOnTheTruthWhereItBegins) {
    const std::string poses = test::contentOf(data / "groundtruth.txt");
    const json all = run().result;
    EXPECT_TRUE(all["nees_per_dof"].is_number());
    test::fs::remove(data / "depth/0.png");  // the first image cannot be used
    const json second = run().result;
    EXPECT_EQ(second["unreadable"], 1);
    EXPECT_NEAR(second["nees_per_dof"].get<double>(), all["nees_per_dof"].get<double>(), 0.5);
    flight.write(data);
    const auto firstLines = [&](int n) {
        std::size_t end = 0;
        while (n-- > 0) end = poses.find('\n', end) + 1;
        return end;
    };
    writeText(data / "groundtruth.txt", poses.substr(firstLines(3)));
    const ReplayReport late = run();
    EXPECT_EQ(late.result["judged"], 9);
    EXPECT_TRUE(late.result["nees_per_dof"].is_null());
    EXPECT_LT(late.result["ate_rmse_m"].get<double>(), 3e-3);
    const Trajectory estimate = readTrajectory((options.out / "trajectory.tum").string());
    EXPECT_TRUE(estimate[3].T_w_c.isApprox(flight.T_w_c(3), 1e-6));
    EXPECT_TRUE(estimate[0].T_w_c.isApprox(flight.T_w_c(0), 5e-3));
    options.start = "1,2,3,0,0,0,1";
    options.out = folder.path() / "refused";
    expectRejected({"--start", "with ground truth"});
}

TEST_F(ReplayCommand, EndingLostIsNoAnswer) {
    for (int i = 9; i < flight.frames; ++i) blacken(i);
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.result["tracked"], 9);
    EXPECT_NE(report.result["verdict"].get<std::string>().find("for good from 50.900 s"),
              std::string::npos);
}

TEST_F(ReplayCommand, InterruptedItKeepsWhatItHas) {
    options.progress = [&](std::size_t done, std::size_t) { running = done == 4; };
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 130);
    EXPECT_TRUE(report.result["interrupted"].get<bool>());
    EXPECT_EQ(report.result["frames"], 4);
    EXPECT_EQ(readTrajectory((options.out / "trajectory.tum").string()).size(), 4U);
    EXPECT_TRUE(test::fs::exists(options.out / "report.html"));
}

TEST_F(ReplayCommand, RejectsWhatItCannotReplay) {
    const auto rejected = [&](auto change, const std::vector<std::string>& parts) {
        const ReplayOptions good = options;
        change();
        expectRejected(parts);
        options = good;
    };
    rejected([&] { options.odometry = false; }, {"--map", "--odometry"});
    rejected([&] { options.mapFile = "x.ot"; }, {"--odometry", "not together"});
    rejected([&] { options.depthScale = 5.; }, {"--depth-scale", "implausible", "too small"});
    rejected([&] { options.depthScale = 5e6; }, {"--depth-scale", "implausible", "too large"});
    rejected([&] { options.every = 0; }, {"--every"});
    rejected([&] { options.up = "q"; }, {"--up", "'q'"});
    rejected([&] { options.stereo = "xy"; }, {"--stereo", "'xy'"});
    rejected([&] { options.stereo = "bm"; }, {"--stereo", "EuRoC"});
    rejected([&] { options.startSigma = 0.1; }, {"--start-sigma", "--map"});
    rejected([&] { options.frames = "3"; }, {"--frames", "'3'"});
    rejected([&] { options.frames = "20:"; }, {"--frames", "none of 12"});
    rejected([&] { options.frames = "3:4"; }, {"single frame"});
    rejected([&] { options.start = "1,2,3"; }, {"--start", "x,y,z,qx"});
    rejected([&] { options.start = "1,2,3,0,0,0,0"; }, {"--start", "unit quaternion"});
    rejected([&] { options.dataset = "/nowhere"; }, {"/nowhere", "no such folder"});
    rejected([&] { options.cameraFile = "/no.yaml"; }, {"/no.yaml", "no such file"});
    rejected([&] { useMap(), options.mapFile = "/no.ot"; }, {"/no.ot"});
    rejected(
        [&] {
            writeText(folder.path() / "large.yaml",
                      "width: 640\nheight: 480\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n");
            options.cameraFile = (folder.path() / "large.yaml").string();
        },
        {"rgb/0.png", "160x120 pixels, not the 640x480 of", "large.yaml (width, height)"});
    rejected(
        [&] {
            writeText(folder.path() / "scaled.yaml",
                      "width: 160\nheight: 120\nfx: 130\nfy: 130\ncx: 80\ncy: 60\n"
                      "depth_scale: 5\n");
            options.cameraFile = (folder.path() / "scaled.yaml").string();
        },
        {"scaled.yaml: depth_scale: implausible"});
    writeText(data / "groundtruth.txt", "5 0 0 1 0 0 0 1\n");
    expectRejected({"groundtruth.txt", "poses from 5.000", "images from 50.000 to 51.100"});
    EXPECT_FALSE(test::fs::exists(options.out));
    test::fs::remove(data / "groundtruth.txt");
    rejected([&] { options.up = "floor"; }, {"--up", "no true poses"});
    const double infinite = std::numeric_limits<double>::infinity();
    rejected([&] { options.depthScale = infinite; }, {"--depth-scale", "above 0"});
}

/// Folders that were there before, and links to them, are the user's.
TEST_F(ReplayCommand, LeavesFoldersThatWereThere) {
    const auto there = folder.path() / "there";
    test::fs::create_directories(there);
    test::fs::create_directory_symlink(there, options.out);
    const auto rgb = data / "rgb";
    test::fs::rename(rgb, data / "elsewhere");
    expectInputError([&] { run(); }, {"rgb/0.png"});
    EXPECT_TRUE(test::fs::is_symlink(options.out));
    test::fs::rename(data / "elsewhere", rgb);
    run();
    EXPECT_TRUE(test::fs::is_symlink(options.out));
    options.out = folder.path() / "empty";
    test::fs::create_directories(options.out);
    test::fs::rename(rgb, data / "elsewhere");
    expectInputError([&] { run(); }, {"rgb/0.png"});
    EXPECT_TRUE(test::fs::exists(options.out));
}

/// Covariances that are far from true do not go unsaid, nor do images that tell only half.
TEST(ReplaySummary, NamesWhatIsNotRight) {
    json result = {{"verdict", "tracked 9 of 9 frames"},
                   {"tracked", 9},
                   {"degenerate", 2},
                   {"lost", 0},
                   {"unreadable", 0},
                   {"skipped", json::array()},
                   {"gaps", json::array()},
                   {"judged", 9},
                   {"laid_on_frame", 0},
                   {"ate_rmse_m", 0.01},
                   {"ate_max_m", 0.02},
                   {"ate_rotation_rmse_deg", 0.1},
                   {"ate_alignment", "none"},
                   {"rpe", {{"frame", nullptr}, {"second", nullptr}, {"metre", nullptr}}},
                   {"nees_per_dof", 49.},
                   {"nees_median_per_dof", 40.},
                   {"depth_density", nullptr},
                   {"fps", 10.},
                   {"fps_with_reading", 5.},
                   {"dataset", {{"layout", "TUM RGB-D"}}}};
    const auto said = [&](const std::string& words) {
        const ReportTable table = replaySummary(result);
        return std::ranges::any_of(table.rows, [&](const auto& row) {
            return row.second.find(words) != std::string::npos;
        });
    };
    EXPECT_TRUE(said("overconfident, errors are 7.0 times the predicted ones"));
    EXPECT_TRUE(said("9 (2 degenerate), 0, 0"));
    result["nees_per_dof"] = 1.2;
    EXPECT_FALSE(said("overconfident"));
}

TEST_F(ReplayCommand, StereoRecordings) {
    test::WallDataset wall{.width = 320, .height = 240, .frames = 6};
    wall.write(folder.path() / "wall");
    options.dataset = (folder.path() / "wall").string();
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(report.result["tracked"], 6);
    EXPECT_EQ(report.result["dataset"]["layout"], "EuRoC");
    EXPECT_EQ(report.result["dataset"]["camera"]["width"], 160);
    EXPECT_EQ(report.result["options"]["stereo"], "bm");
    EXPECT_GT(report.result["depth_density"].get<double>(), 0.3);
    EXPECT_LT(report.result["depth_density"].get<double>(), 1.);
    EXPECT_LT(report.result["ate_rmse_m"].get<double>(), 5e-3);
    const Trajectory truth = readTrajectory((options.out / "groundtruth.tum").string());
    const Pose expected = wall.T_w_b(2) * wall.camera(0).T_b_c;
    EXPECT_LT((truth[2].T_w_c.translation() - expected.translation()).norm(), 1e-5);
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
    test::fs::remove_all(cam1);
    expectInputError([&] { run(); }, {"cam1", "no such folder"});
}

TEST_F(ReplayCommand, ABlackStereoRecordingIsLost) {
    const test::WallDataset wall{.width = 320, .height = 240, .frames = 4};
    wall.write(folder.path() / "wall");
    for (const char* camera : {"cam0", "cam1"}) {
        for (const auto& image :
             test::fs::directory_iterator(folder.path() / "wall/mav0" / camera / "data")) {
            cv::imwrite(image.path().string(), cv::Mat(240, 320, CV_8UC1, cv::Scalar(0)));
        }
    }
    options.dataset = (folder.path() / "wall").string();
    const ReplayReport report = run();
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.result["verdict"], "lost at once: all 4 images are black");
}

TEST_F(ReplayCommand, FromTheCommandLine) {
    const Execution good = photonav(
        fmt::format("replay {} --odometry --out {} --json", data.string(), options.out.string()));
    EXPECT_EQ(good.exitCode, 0) << good.output;
    EXPECT_EQ(json::parse(good.output)["tracked"], 12);
    const Execution bad = photonav(fmt::format("replay {} --odometry --depth-scale 5 --out {}",
                                               data.string(), options.out.string()));
    EXPECT_EQ(bad.exitCode, 2);
    EXPECT_TRUE(bad.output.starts_with("photonav: ")) << bad.output;
    EXPECT_EQ(std::count(bad.output.begin(), bad.output.end(), '\n'), 1) << bad.output;
}

}  // namespace
}  // namespace photonav
