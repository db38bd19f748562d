// SPDX-License-Identifier: BSD-3-Clause
// `photonav fly`, run as a user runs it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/executable.hpp"
#include "dataset/sequence_tum.hpp"
#include "dataset/trajectory.hpp"
#include "flight/flight_set.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A small image, coarse views and few vertices: a flight takes a fraction of a second.
const std::string kQuickFlight =
    " --set planner.vertices=150 --set planner.view_pitch=0.5 --set camera.width=94"
    " --set camera.height=60 --set goal=[2,3,2] ";

class FlyCommand : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    Execution fly(const std::string& name, const std::string& arguments) const {
        return photonav(fmt::format("fly {} {} {} --out {}", config("two_textures"), kQuickFlight,
                                    arguments, at(name)));
    }

    json result(const std::string& name) const {
        return json::parse(std::ifstream(folder_ / name / "result.json"));
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST_F(FlyCommand, FliesBothPlannersAndWritesWhatOthersRead) {
    const Execution run = fly("a", "--flights 2 --record " + at("recorded"));
    ASSERT_TRUE(run.exitCode == 0 || run.exitCode == 1) << run.output;
    const json a = result("a");
    EXPECT_EQ(a["command"], "fly");
    ASSERT_EQ(a["planners"].size(), 2U);
    for (const json& planner : a["planners"]) {
        EXPECT_EQ(planner["flights"], 2);
        EXPECT_EQ(planner["each"].size(), 2U);
        for (const char* key : {"collisions", "position_rmse_m", "predicted_sigma_m",
                                "nees_per_dof", "lost_s", "mean_speed_mps"}) {
            EXPECT_TRUE(planner[key].is_number()) << key;
        }
        EXPECT_TRUE(planner["each"][0]["rejected_images"].is_number());
        EXPECT_TRUE(planner["each"][0]["mean_speed_mps"].is_number());
    }
    // Whether the shortest path arrives does not count.
    const bool hasArrived = a["planners"][0]["arrived"].get<int>() > 0;
    EXPECT_EQ(run.exitCode, hasArrived ? 0 : 1);
    EXPECT_NE(run.output.find("NEES at goal"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("astray"), std::string::npos) << run.output;
    for (const char* name : {"report.html", "errors.png", "nees.png", "top_view.png", "config.yaml",
                             "trajectory.cov", "trajectory.ov"}) {
        EXPECT_TRUE(fs::exists(folder_ / "a" / name)) << name;
    }
    const json frames = json::parse(std::ifstream(folder_ / "a/report.json"))["frames"];
    std::map<std::string, int> played;
    for (const json& frame : frames) ++played[frame["series"]];
    ASSERT_EQ(played.size(), 2U);
    EXPECT_GE(played["belief_rrt_star, flight 0"], 3);
    EXPECT_LE(played["belief_rrt_star, flight 0"], 40);
    EXPECT_NE(frames[0]["caption"].get<std::string>().find("0.0 s: image used"), std::string::npos);
    // The robot of the picture is where it believed to be then.
    const Trajectory believed = readTrajectory(at("a/trajectory.tum"));
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(frames[0]["believed"]["position"][i], believed[0].T_w_c.translation()[i], 1e-6);
    }
    const Trajectory truth = readTrajectory(at("a/groundtruth.tum"));
    EXPECT_NEAR(frames[0]["truth"][0], truth[0].T_w_c.translation().x(), 1e-6);
    EXPECT_EQ(readTrajectory(at("a/trajectory.tum")).size(), truth.size());
    const Sequence recorded = readTumSequence(at("recorded"));
    ASSERT_EQ(recorded.frames.size(), truth.size());
    EXPECT_EQ(recorded.informationScale, 0.08);  // of the config
    const RecordedFrame frame = loadFrame(recorded, 3);
    EXPECT_TRUE(frame.T_c_w.inverse().isApprox(truth[3].T_w_c, 1e-6));
    EXPECT_NEAR(frame.view.depth[30][47], truth[3].T_w_c.translation().z(), 0.01);
}

TEST_F(FlyCommand, IsDeterministicWhateverTheThreads) {
    ASSERT_NE(fly("a", "--flights 3 --seed 4").exitCode, 2);
    ASSERT_NE(fly("b", "--flights 3 --seed 4 --jobs 3").exitCode, 2);
    EXPECT_EQ(result("a")["planners"], result("b")["planners"]);
}

TEST_F(FlyCommand, FliesThePlanOfAResultFolder) {
    const Execution planned = photonav(
        fmt::format("plan {} {} --out {}", config("two_textures"), kQuickFlight, at("plan")));
    ASSERT_EQ(planned.exitCode, 0) << planned.output;
    const Execution over =
        photonav(fmt::format("fly {} --record {} --out {}", at("plan"), at("plan"), at("x")));
    EXPECT_EQ(over.exitCode, 2);
    EXPECT_NE(over.output.find("--record: " + at("plan") + ": is or contains"), std::string::npos)
        << over.output;
    for (const std::string what : {"plan", "plan/result.json", "plan/path.tum"}) {
        const Execution run =
            photonav(fmt::format("fly {} --flights 1 --out {} "
                                 "--set planner.compare_with_rrt_star=false",
                                 at(what), at("flown")));
        EXPECT_NE(run.exitCode, 2) << run.output;
        const json flown = result("flown")["planners"];
        ASSERT_EQ(flown.size(), 1U);
        EXPECT_NEAR(flown[0]["length_m"], result("plan")["length"], 1e-6);
    }
}

TEST_F(FlyCommand, ItsConfigRepeatsTheRun) {
    std::ofstream(folder_ / "calibration.yaml")
        << "scale: 0.2\nleast_sigma: 0.01\nleast_sigma_rotation: 0.001\ncorrelation_time: 4\n";
    ASSERT_NE(fly("a",
                  "--flights 2 --seed 3 --camera real --odometry 4 --latency 0.1 --rate 5"
                  " --blackout 3,0.2 --drop 0.1 --speed 0.8 --no-photometric-goal"
                  " --calibration " +
                      at("calibration.yaml") + " --least-sigma-rotation 0.004 --map " +
                      PHOTONAV_SOURCE_DIR + "/config/scenes/two_textures.yaml")
                  .exitCode,
              2);
    const auto again = [&](const std::string& from, const std::string& to) {
        return photonav(fmt::format("fly {} --out {}", at(from + "/config.yaml"), at(to)));
    };
    const Execution run = again("a", "b");
    ASSERT_NE(run.exitCode, 2) << run.output;
    EXPECT_EQ(result("a")["planners"], result("b")["planners"]);
    EXPECT_EQ(result("a")["flight"], result("b")["flight"]);
    EXPECT_EQ(result("a")["flight"]["scale"], 0.05);  // 0.2 over 4 images
    EXPECT_EQ(result("a")["flight"]["camera"], "real");
    EXPECT_EQ(result("a")["flight"]["exposure_prior"]["gain_sigma"], 0.1);
    EXPECT_EQ(result("a")["flight"]["photometric_goal"], false);
    EXPECT_EQ(result("a")["flight"]["least_sigma"], json({0.01, 0.004}));
    EXPECT_EQ(test::contentOf(folder_ / "a/config.yaml"),
              test::contentOf(folder_ / "b/config.yaml"));
    EXPECT_NE(photonav(fmt::format("fly {} --flights 1 --camera assumed --out {}",
                                   at("a/config.yaml"), at("c")))
                  .exitCode,
              2);
    EXPECT_EQ(result("c")["planners"][0]["flights"], 1);  // options go over the config
    EXPECT_NE(test::contentOf(folder_ / "c/config.yaml").find("rate: 5"), std::string::npos);
    const Execution bad = photonav(fmt::format("fly {} --set fly.odometri=2", at("a/config.yaml")));
    EXPECT_EQ(bad.exitCode, 2);
    EXPECT_NE(bad.output.find("fly.odometri: unknown key, did you mean 'fly.odometry'"),
              std::string::npos)
        << bad.output;
}

TEST_F(FlyCommand, TheConfigOfAFlownPlanFliesThatPlan) {
    ASSERT_EQ(photonav(fmt::format("plan {} {} --set planner.compare_with_rrt_star=false --out {}",
                                   config("two_textures"), kQuickFlight, at("plan")))
                  .exitCode,
              0);
    ASSERT_NE(photonav(fmt::format("fly {} --flights 1 --set planner.vertices=20 --out {}",
                                   at("plan"), at("a")))
                  .exitCode,
              2);
    ASSERT_NE(photonav(fmt::format("fly {} --out {}", at("a/config.yaml"), at("b"))).exitCode, 2);
    EXPECT_NEAR(result("b")["planners"][0]["length_m"], result("plan")["length"], 1e-6);
    EXPECT_EQ(result("a")["planners"], result("b")["planners"]);
    fs::remove_all(folder_ / "plan");
    const Execution gone = photonav(fmt::format("fly {}", at("a/config.yaml")));
    EXPECT_EQ(gone.exitCode, 2);
    EXPECT_NE(gone.output.find("plan/result.json: no such file"), std::string::npos) << gone.output;
}

TEST_F(FlyCommand, WhatWasNeverFlownHasNoErrors) {
    // Interrupted among the first of many flights: those of the second planner never begin. (While
    // it still plans, there would be no result.)
    const Execution run =
        interrupt(fmt::format("{} fly {} {} --flights 1000 --quiet --out {}", PHOTONAV_BINARY,
                              config("two_textures"), kQuickFlight, at("out")),
                  fmt::format("[ -d {}.unfinished ]", at("out")), 1.);
    EXPECT_EQ(run.exitCode, 130) << run.output;
    const json r = result("out");
    EXPECT_EQ(r["status"], "interrupted");
    for (const json& planner : r["planners"]) {
        if (planner["flights"] != 0) continue;
        for (const char* key : {"position_rmse_m", "predicted_sigma_m", "believed_sigma_m",
                                "nees_per_dof", "duration_s", "goal_error_m"}) {
            EXPECT_TRUE(planner[key].is_null()) << key << planner[key];
        }
    }
    FlightSet none;
    none.plan = {PlannedView{}};
    EXPECT_TRUE(std::isnan(summarise(none).positionRmse));
    EXPECT_TRUE(std::isnan(summarise(none).nees));
    EXPECT_TRUE(std::isnan(summarise(none).goalError));
}

TEST_F(FlyCommand, RecordsNothingWhereNothingFlies) {
    const Execution run =
        photonav(fmt::format("fly {} --set planner.vertices=2 --record {} --out {}", config("room"),
                             at("recorded"), at("out")));
    EXPECT_EQ(run.exitCode, 1) << run.output;
    EXPECT_FALSE(fs::exists(at("recorded")));
}

/// Images that are only late are not missed.
TEST_F(FlyCommand, LatencyIsNotLoss) {
    fly("late", "--flights 1 --latency 2 --set planner.compare_with_rrt_star=false");
    EXPECT_EQ(result("late")["planners"][0]["each"][0]["times_lost"], 0);
}

TEST_F(FlyCommand, ExitsWithOneWhenNoFlightArrives) {
    const Execution run =
        fly("dark", "--flights 1 --black 1 --set planner.compare_with_rrt_star=false");
    EXPECT_EQ(run.exitCode, 1) << run.output;
    EXPECT_EQ(result("dark")["planners"][0]["each"][0]["end"], "lost");
    EXPECT_GT(result("dark")["planners"][0]["lost_s"].get<double>(), 5.);
}

TEST_F(FlyCommand, RejectsBadInput) {
    const auto expect = [](const Execution& run, const std::string& reason) {
        EXPECT_EQ(run.exitCode, 2) << run.output;
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    };
    expect(fly("x", "--blackout 3"), "--blackout: expected 2 numbers, found 1");
    expect(fly("x", "--blackout [3]"), "--blackout: expected 2 numbers, found 1");
    expect(fly("x", "--flights 0"), "--flights");
    expect(fly("x", "--scale 0"), "--scale: 0 is outside [1e-12, 1e+12]");
    expect(fly("x", "--least-sigma -1"), "--least-sigma: -1 is outside [0, 1]");
    expect(fly("x", "--record /proc/x"), "/proc/x: cannot be made");
    fs::create_directories(folder_ / "old" / "rgb");
    expect(fly("x", "--record " + at("old")), "old: holds a recording already");
    fs::create_directories(folder_ / "x");
    std::ofstream(folder_ / "x" / "result.json") << "{}";  // not of an earlier run
    expect(fly("x", "--record " + at("new")),
           "x/result.json: is not of an earlier result, or was changed since");
    EXPECT_TRUE(fs::exists(folder_ / "x" / "result.json"));
    EXPECT_FALSE(fs::exists(folder_ / "new"));
    fs::remove_all(folder_ / "x");
    expect(fly("x", "--seed abc"), "--seed");
    expect(fly("x", "--map " + at("gone.ot")), "gone.ot");
    const auto calibration = [&](const std::string& text) {
        std::ofstream(folder_ / "calibration.yaml") << text;
        return fly("x", "--calibration " + at("calibration.yaml"));
    };
    expect(calibration("least_sigma: 0.01\n"), "calibration.yaml: scale: missing");
    expect(calibration("scale: 1\n"), "calibration.yaml: least_sigma: missing");
    expect(calibration("scale: 1\nleast_sigma_rotation: 0\nleast_sigma: [0.01, 0.005]\n"),
           "calibration.yaml: least_sigma: ");
    expect(calibration("scale: [\n"), "calibration.yaml");
    expect(calibration("scale: 1\nleast_sigma: 0\nleast_sigma_rotation: 0\nmode: odometry\n"),
           "calibration.yaml: mode: is odometry");
    expect(
        calibration("scale: 1\nleast_sigma: 0\nleast_sigma_rotation: 0\ncorrelation_time: 0.5\n"),
        "calibration.yaml: correlation_time: ");
    expect(photonav("fly " + at("")), "not a result of photonav plan");
    fs::create_directories(folder_ / "no");
    fs::copy(config("two_textures"), folder_ / "no" / "config.yaml");
    std::ofstream(folder_ / "no" / "result.json") << R"({"command": "map"})";
    expect(photonav(fmt::format("fly {} --set scene.file={}/config/scenes/two_textures.yaml "
                                "--out {}",
                                at("no"), PHOTONAV_SOURCE_DIR, at("x"))),
           "not a result of photonav plan");
    EXPECT_FALSE(fs::exists(folder_ / "x" / "result.json"));
}

}  // namespace
}  // namespace photonav
