// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/replay_command.hpp"

#include "app/executable.hpp"
#include "dataset/colmap_model.hpp"
#include "dataset/trajectory.hpp"
#include "flight_dataset.hpp"
#include "recordings/replay_report.hpp"
#include "replay/calibration_file.hpp"
#include "shared/command_io.hpp"

namespace photonav {
namespace {

using nlohmann::json;
using test::expectInputError;
using test::FlightDataset;
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

    CommandReport run() { return runReplay(options, running); }
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

    FlightDataset flight;
    test::TemporaryFolder folder;
    test::fs::path data = folder.path() / "flight";
    ReplayCommandOptions options;
    std::atomic<bool> running{false};
};

TEST_F(ReplayCommand, WritesWhatOtherProgramsRead) {
    const CommandReport report = run();
    for (const char* name : {"report.html", "errors.png", "strips.png", "top_view.png"}) {
        EXPECT_TRUE(test::fs::exists(options.out / name)) << name;
    }
    std::ifstream in(options.out / "result.json");
    EXPECT_EQ(json::parse(in), report.result);
    EXPECT_EQ(report.result["dataset"]["layout"], "TUM RGB-D");
    EXPECT_EQ(report.result["options"]["mode"], "odometry");
    const Trajectory estimate = readTrajectory((options.out / "trajectory.tum").string());
    const Trajectory truth = readTrajectory((options.out / "groundtruth.tum").string());
    ASSERT_EQ(estimate.size(), 12U);
    ASSERT_EQ(truth.size(), 12U);
    EXPECT_TRUE(truth[5].T_w_c.isApprox(flight.T_w_c(5), 1e-5));
    EXPECT_TRUE(estimate[5].T_w_c.isApprox(flight.T_w_c(5), 5e-3));
    const Trajectory kitti = readKittiTrajectory((options.out / "trajectory.kitti").string());
    ASSERT_EQ(kitti.size(), 12U);
    EXPECT_TRUE(kitti[5].T_w_c.isApprox(estimate[5].T_w_c, 1e-6));
    const Sequence model = readColmapSequence(options.out.string());
    ASSERT_EQ(model.frames.size(), 12U);
    for (const Sequence::Entry& image : model.frames) {  // named as in the folder of the dataset
        EXPECT_TRUE(test::fs::exists(
            data / test::fs::path(image.colourFile).lexically_relative(options.out)))
            << image.colourFile;
    }
    EXPECT_TRUE(model.frames[0].T_c_w.isApprox(estimate[0].T_w_c.inverse(), 1e-6));
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
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 17) << line;
    }
    EXPECT_EQ(rows, 13);
}

TEST_F(ReplayCommand, CalibrationMakesCovariancesConsistent) {
    FlightDataset longer{.frames = 30, .speed = 0.02};
    longer.write(data);
    useMap();
    options.calibrate = true;
    const json result = run().result;
    EXPECT_GT(result["options"]["scale"], 0.);
    const json fitted = result["calibration"];
    EXPECT_GE(fitted["correlation_time"], 1.);
    EXPECT_NEAR(fitted["nees_after"].get<double>(), 1., 0.3);
    const Calibration read = readCalibration((options.out / "calibration.yaml").string());
    EXPECT_NEAR(read.scale, fitted["scale"].get<double>(), 0.01 * read.scale);
    EXPECT_NEAR(read.leastSigma, fitted["least_sigma"][0].get<double>(), 1e-4);
    EXPECT_NEAR(read.leastSigmaRotation, fitted["least_sigma"][1].get<double>(), 1e-4);
    options.calibration = (options.out / "calibration.yaml").string();
    expectInputError([&] { run(); }, {"--out", "calibration.yaml, which this run reads"});
    EXPECT_TRUE(test::fs::exists(options.calibration));
    options.calibration.clear();
    options.frames = ":10";
    EXPECT_TRUE(run().result["calibration"].is_null());
}

TEST_F(ReplayCommand, InterruptedAtOnceLeavesAnEarlierResult) {
    run();
    const std::string before = test::contentOf(options.out / "result.json");
    running = true;
    EXPECT_EQ(run().exitCode, kInterrupted);
    EXPECT_EQ(test::contentOf(options.out / "result.json"), before);
}

TEST_F(ReplayCommand, WithoutAnEarlierResultAnInterruptedOneIsWritten) {
    running = true;
    EXPECT_EQ(run().exitCode, kInterrupted);
    EXPECT_TRUE(test::fs::exists(options.out / "result.json"));
}

TEST_F(ReplayCommand, ItsConfigRepeatsTheRun) {
    useMap();
    options.frames = "1:9";
    options.every = 2;
    options.startSigma = 0.02;
    options.leastSigma = 0.003;
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
    EXPECT_EQ(second["options"]["least_sigma"][0], 0.003);
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

TEST_F(ReplayCommand, EndingLostIsNoAnswer) {
    for (int i = 9; i < flight.frames; ++i) flight.blacken(data, i);
    const CommandReport report = run();
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.result["tracked"], 9);
    EXPECT_NE(report.result["verdict"].get<std::string>().find("for good from 50.900 s"),
              std::string::npos);
    EXPECT_TRUE(test::fs::exists(options.out / "report.html"));
}

TEST_F(ReplayCommand, WhatIsRefusedLeavesAnEarlierResultWhole) {
    options.depthScale = 5.;
    expectInputError([&] { run(); }, {"--depth-scale", "implausible"});
    EXPECT_FALSE(test::fs::exists(options.out));
    options.depthScale.reset();
    run();
    options.depthScale = 5.;
    expectInputError([&] { run(); }, {"--depth-scale", "implausible"});
    for (const char* name : {"result.json", "strips.png", "groundtruth.tum"}) {
        EXPECT_TRUE(test::fs::exists(options.out / name)) << name;
    }
}

TEST_F(ReplayCommand, InterruptedItKeepsWhatItHas) {
    options.progress = [&](std::size_t done, std::size_t) { running = done == 4; };
    const CommandReport report = run();
    EXPECT_EQ(report.exitCode, 130);
    EXPECT_TRUE(report.result["interrupted"].get<bool>());
    EXPECT_EQ(report.result["frames"], 4);
    EXPECT_EQ(readTrajectory((options.out / "trajectory.tum").string()).size(), 4U);
    EXPECT_TRUE(test::fs::exists(options.out / "report.html"));
}

TEST_F(ReplayCommand, InterruptedItLeavesAnEarlierResultWhole) {
    run();
    const std::string whole = test::contentOf(options.out / "result.json");
    options.progress = [&](std::size_t done, std::size_t) { running = done == 4; };
    const CommandReport report = run();
    EXPECT_EQ(test::contentOf(options.out / "result.json"), whole);
    EXPECT_EQ(report.folder, options.out.string() + "-interrupted");
    EXPECT_EQ(readTrajectory((report.folder / "trajectory.tum").string()).size(), 4U);
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

/// Covariances that are far from true are reported, and so are images that inform of half of the
/// directions only.
TEST(ReplaySummary, NamesWhatIsNotRight) {
    json result = {{"verdict", "tracked 9 of 9 frames"},
                   {"mode", "cells"},
                   {"tracked", 9},
                   {"degenerate", 2},
                   {"lost", 0},
                   {"unreadable", 0},
                   {"skipped", json::array()},
                   {"gaps", json::array()},
                   {"judged", 9},
                   {"aligned_frame", 0},
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
                   {"dataset",
                    {{"layout", "TUM RGB-D"},
                     {"depth_noise_m", 7e-4},
                     {"depth_error", 0.1},
                     {"depth_error_assumed", true}}}};
    const auto said = [&](const std::string& words) {
        const ReportTable table = replaySummary(result);
        return std::ranges::any_of(table.rows, [&](const auto& row) {
            return row.second.find(words) != std::string::npos;
        });
    };
    EXPECT_TRUE(said("overconfident, errors are 6.3 times the predicted ones in the median"));
    EXPECT_TRUE(said("9 (2 degenerate), 0, 0"));
    EXPECT_TRUE(said("no surfaces inside its cells"));
    result["mode"] = "surfaces";
    EXPECT_FALSE(said("no surfaces"));
    EXPECT_TRUE(said("10 % of the motion, assumed (noise 0.7 mm at 1 m"));
    result["dataset"]["depth_error"] = 0.;
    EXPECT_FALSE(said("of the motion"));
    result["nees_median_per_dof"] = 1.1;
    EXPECT_TRUE(said("overconfident in some images"));
    EXPECT_FALSE(said("times the predicted"));
    result["nees_per_dof"] = 1.2;
    EXPECT_FALSE(said("overconfident"));
    result["blur"] = {
        {"assumed", 0.29}, {"estimated", 0.}, {"variance_sigma", 0.1}, {"contradicts", false}};
    EXPECT_TRUE(said("0.29 pixels assumed, 0.00 by the images"));
    result["blur"]["variance_sigma"] = 0.8;
    EXPECT_TRUE(said("0.29 pixels assumed; these images do not show it"));
    result["blur"]["contradicts"] = true;
    EXPECT_TRUE(said("give `blur` in camera.yaml"));
}

TEST_F(ReplayCommand, FromTheCommandLine) {
    const Execution good = photonav(
        fmt::format("replay {} --odometry --out {} --json", data.string(), options.out.string()));
    EXPECT_EQ(good.exitCode, 0) << good.output;
    EXPECT_EQ(json::parse(good.output)["tracked"], 12);
    const Execution typed =
        photonav(fmt::format("replay {} --odometry --out {} --frames 2: --max-width 80 "
                             "--no-exposure --sigma 0.03 --json",
                             data.string(), options.out.string()));
    ASSERT_EQ(typed.exitCode, 0) << typed.output;
    const json used = json::parse(typed.output)["options"];
    EXPECT_EQ(used["frames"], "2:");
    EXPECT_EQ(used["max_width"], 80);
    EXPECT_EQ(used["exposure"], false);
    EXPECT_EQ(used["sigma"], 0.03);
    for (const char* wrong : {"--max-width 10", "--min-overlap 1", "--every 1.5", "--sigma x"}) {
        const Execution run =
            photonav(fmt::format("replay {} --odometry {}", data.string(), wrong));
        const std::string option(wrong, std::string_view(wrong).find(' '));
        EXPECT_EQ(run.exitCode, 2) << wrong;
        EXPECT_TRUE(run.output.starts_with("photonav: " + option)) << run.output;
    }
    const Execution bad = photonav(fmt::format("replay {} --odometry --depth-scale 5 --out {}",
                                               data.string(), options.out.string()));
    EXPECT_EQ(bad.exitCode, 2);
    EXPECT_TRUE(bad.output.starts_with("photonav: ")) << bad.output;
    EXPECT_EQ(std::count(bad.output.begin(), bad.output.end(), '\n'), 1) << bad.output;
}

}  // namespace
}  // namespace photonav
