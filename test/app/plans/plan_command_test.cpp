// SPDX-License-Identifier: BSD-3-Clause
// photonav plan, as a user runs it.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "app/command_test.hpp"
#include "io/stopwatch.hpp"
#include "plans/plan_command.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class PlanCommand : public CommandTest {};

TEST_F(PlanCommand, WritesEverythingItPromises) {
    const Execution run = plan(std::string("--audit") + kQuickPlan);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    for (const char* name :
         {"result.json", "config.yaml", "path.tum", "top_view.png", "trace.png", "trace.svg",
          "trace.pdf", "views.png", "information.png", "report.json", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    }
    const json r = result();
    for (const char* key : {"schema", "command", "version", "seed", "planner", "alpha", "cost",
                            "length", "mean_trace", "goal_trace", "vertices", "iterations", "views",
                            "cache_hits", "time", "audit", "path"}) {
        EXPECT_TRUE(r.contains(key)) << key;
    }
    const double lengthInJ = r["metric_length"];  // nothing turns here
    EXPECT_NEAR(lengthInJ, r["length"].get<double>(), 1e-9);
    EXPECT_NEAR(r["cost"].get<double>(),
                (0.1 + 0.9 * 2.5 * r["mean_trace"].get<double>()) * lengthInJ, 1e-9);
    for (const char* key : {"total_s", "views_s", "beliefs_s", "tree_s"}) {
        EXPECT_GE(r["time"][key].get<double>(), 0.) << key;
    }
    EXPECT_LT(r["audit"]["max_cost_error"].get<double>(), 1e-9);
    EXPECT_LT(r["audit"]["max_covariance_error"].get<double>(), 1e-9);
    EXPECT_EQ(r["path"].front()["position"], json({0., 0., 2.}));
    EXPECT_EQ(r["path"].back()["position"], json({2., 9., 2.}));
    EXPECT_EQ(r["path"].back()["covariance"].size(), 21U);
    EXPECT_NEAR(r["path"].back()["cost"].get<double>(), r["cost"].get<double>(), 1e-9);
    EXPECT_NEAR(r["path"].back()["trace"].get<double>(), r["goal_trace"].get<double>(), 1e-12);
}

TEST_F(PlanCommand, EvolutionIsAFigureAndAnAnimation) {
    const Execution run = plan(std::string("--evolution") + kQuickPlan);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    EXPECT_TRUE(fs::exists(folder_ / "tree_evolution.png"));
    std::ifstream stream(folder_ / "report.json");
    const json report = json::parse(stream);
    ASSERT_EQ(report["frames"].size(), 6U);  // 10, 20, 50, 100, 200 and 300 vertices
    EXPECT_EQ(report["frames"][0]["caption"], "10 vertices");
    EXPECT_EQ(report["frames"][5]["caption"], "300 vertices");
    EXPECT_NE(report["frames"][0]["image"], report["frames"][5]["image"]);
}

TEST_F(PlanCommand, TheDetourReducesUncertainty) {
    ASSERT_EQ(plan(kQuickPlan).exitCode, 0);
    const json r = result();
    EXPECT_GT(r["length"].get<double>(), r["baseline"]["length"].get<double>() + 1.);
    EXPECT_LT(r["goal_trace"].get<double>(), 0.2 * r["baseline"]["goal_trace"].get<double>());
    EXPECT_LT(r["cost"].get<double>(), r["baseline"]["cost"].get<double>());
}

/// The share of each term is printed; where the shortest path is no worse, that is said.
TEST_F(PlanCommand, SaysWhatItsCostConsistsOf) {
    expectBadInput(plan("--kappa much"), "planner.kappa: cannot read");
    expectBadInput(plan("--alpha 2"), "planner.alpha: 2 is outside [0, 1]");
    const Execution usual = plan("--kappa auto --alpha 0.4" + std::string(kQuickPlan));
    EXPECT_EQ(usual.exitCode, 0) << usual.output;
    const json r = result();
    EXPECT_EQ(r["alpha"], 0.4);
    EXPECT_EQ(r["kappa_is_automatic"], true);
    EXPECT_NEAR(r["baseline"]["length_share"].get<double>(), 0.4, 1e-9);
    EXPECT_NEAR(r["baseline"]["uncertainty_share"].get<double>(), 0.6, 1e-9);
    EXPECT_FALSE(r.contains("verdict"));
    EXPECT_NE(usual.output.find("% uncertainty (alpha 0.4, kappa "), std::string::npos);
    const Execution little = plan("--kappa 1e-6" + std::string(kQuickPlan));
    EXPECT_NE(little.output.find("no advantage over the shortest path: uncertainty is only"),
              std::string::npos)
        << little.output;
}

TEST_F(PlanCommand, IsDeterministicAndItsConfigRepeatsIt) {
    ASSERT_EQ(plan(std::string("--seed 7") + kQuickPlan).exitCode, 0);
    const json first = result();
    const fs::path copy = folder_.string() + "_config.yaml";
    fs::copy_file(folder_ / "config.yaml", copy, fs::copy_options::overwrite_existing);
    ASSERT_EQ(photonav("plan " + copy.string() + " --out " + folder_.string()).exitCode, 0);
    const json second = result();
    EXPECT_EQ(first["path"], second["path"]);
    EXPECT_EQ(first["seed"], 7);
    fs::remove(copy);
}

TEST_F(PlanCommand, RrtStarRendersNoViewWhilePlanning) {
    ASSERT_EQ(plan(std::string("--set planner.name=rrt_star") + kQuickPlan).exitCode, 0);
    EXPECT_EQ(result()["views"], 0);
    EXPECT_EQ(result()["alpha"], 1.);
    EXPECT_GT(result()["goal_trace"].get<double>(), 0.1);
}

TEST_F(PlanCommand, NoPathIsExitCodeOneWithResults) {
    const Execution run = plan("--set planner.vertices=2");  // the goal is not among the first two
    EXPECT_EQ(run.exitCode, 1) << run.output;
    EXPECT_EQ(result()["status"], "no path");
    EXPECT_TRUE(result()["path"].empty());
    EXPECT_TRUE(fs::exists(folder_ / "report.html"));
    EXPECT_FALSE(fs::exists(folder_ / "information.png"));  // nothing to look for
}

TEST_F(PlanCommand, AStartInsideAnObstacleIsRefused) {
    expectBadInput(plan("--set bounds=[[-1,-0.5,0.1],[9,9.5,2]] --set start=[0,0,0.1]"),
                   "start: in collision: clearance");
}

TEST_F(PlanCommand, ASceneFileIsNoConfig) {
    expectBadInput(plan("", "scenes/kitchen"),
                   "scenes/kitchen.yaml: is a scene file; name it as scene.file in a config");
}

TEST_F(PlanCommand, CtrlCKeepsTheBestPathSoFar) {
    const std::string command = fmt::format(
        "{} plan {} --set planner.vertices=1000000 --set planner.view_pitch=0.5 --quiet --out {}",
        PHOTONAV_BINARY, config("two_textures"), folder_.string());
    for (double seconds = 2.; seconds < 100. && !fs::exists(folder_); seconds *= 3.) {
        EXPECT_EQ(interrupt(command, kCatchesSignals, seconds).exitCode, 130);
    }
    EXPECT_EQ(result()["status"], "interrupted");
    EXPECT_FALSE(result()["path"].empty());
}

TEST_F(PlanCommand, CtrlCWhileTheEvolutionIsDrawnKeepsThePath) {
    PlanOptions options;
    options.config = config("two_textures");
    options.overrides = {"planner.vertices=100"};
    options.out = folder_;
    options.quiet = true;
    options.evolution = true;
    int kept = 0, code = kInterrupted;
    for (double seconds = 0.1; code == kInterrupted && seconds < 100.;
         seconds *= 1.5) {  // later, until it has ended
        fs::remove_all(folder_);
        std::atomic<bool> interrupted{false};
        const std::jthread timer([&] {
            std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
            interrupted = true;
        });
        ASSERT_NO_THROW(code = runPlan(options, interrupted)) << "after " << seconds;
        kept += code == kInterrupted && fs::exists(folder_) && !result()["path"].empty();
    }
    EXPECT_EQ(code, kDone);
    EXPECT_GT(kept, 0);
}

/// The texture of this scene takes seconds.
TEST_F(PlanCommand, InterruptedWithoutAPathLeavesAnEarlierResult) {
    ASSERT_EQ(plan(kQuickPlan).exitCode, 0);
    const json before = result();
    PlanOptions options;
    options.config = config("two_textures");
    options.out = folder_;
    const std::atomic<bool> interrupted{true};
    EXPECT_EQ(runPlan(options, interrupted), kInterrupted);
    EXPECT_EQ(result(), before);
}

TEST_F(PlanCommand, CtrlCBeforeThereIsAResultEndsAtOnce) {
    fs::create_directories(folder_);
    const fs::path scene = folder_ / "scene.yaml";
    std::ofstream(scene)
        << "textures: [{name: a, type: noise, size: [99, 99], cells: [9, 8, 7, 6]}]\n"
           "planes: [{corner: [0, 0, 0], u: [9, 0, 0], v: [0, 9, 0], texture: a}]\n";
    const Stopwatch watch;
    const Execution run =
        interrupt(fmt::format("{} plan {} --set scene.file={} --out {}", PHOTONAV_BINARY,
                              config("two_textures"), scene.string(), (folder_ / "out").string()),
                  kCatchesSignals, 0.3);
    EXPECT_EQ(run.exitCode, 130);
    EXPECT_LT(watch.seconds(), 20.);
    EXPECT_EQ(run.output, "photonav: interrupted before there was any result\n");
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

/// A map of a small recording, and a config for planning in it.
class RecordedMap : public PlanCommand {
  protected:
    void SetUp() override {
        PlanCommand::SetUp();
        test::FloorDataset().write(folder_ / "data");
        ASSERT_EQ(photonav("map " + path("data") + " --out " + path("map")).exitCode, 0);
        std::ofstream(folder_ / "plan.yaml")
            << "map: {file: map/map.ot, unknown: free}\nbounds: [[0, -0.2, 1.4], [0.5, 0.2, 1.6]]\n"
               "start: [0, 0, 1.52]\ngoal: [0.5, 0.1, 1.52]\nrobot: {radius: 0.1}\n"
               "planner: {vertices: 150, view_pitch: 0.1, ds: 0.1}\n";
    }
    std::string path(const char* name) const { return (folder_ / name).string(); }
    Execution planned(const std::string& arguments) {
        Execution run =
            photonav("plan " + path("plan.yaml") + " --out " + path("result") + arguments);
        result_ = json::parse(std::ifstream(folder_ / "result" / "result.json"));
        return run;
    }
    bool has(const char* name) const { return fs::exists(folder_ / "result" / name); }
    json result_;
};

TEST_F(RecordedMap, PlansAreShownBesideTheNearestRecordedFrames) {
    ASSERT_EQ(planned("").exitCode, 0);
    const json frames = result_["recorded_frames"];
    ASSERT_GE(frames.size(), 2U);
    EXPECT_NEAR(frames.front()["stamp"].get<double>(), 100., 1e-6);
    EXPECT_NEAR(frames.front()["distance_m"].get<double>(), 0., 1e-6);
    EXPECT_NEAR(frames.back()["stamp"].get<double>(), 100.5, 1e-6);
    EXPECT_NEAR(frames.back()["distance_m"].get<double>(), 0.1, 1e-6);
    for (const json& frame : frames) {
        EXPECT_NEAR(frame["angle_deg"].get<double>(), 0., 1e-3);
        EXPECT_LT(frame["mean_abs_difference"].get<double>(), 0.03);
    }
    EXPECT_TRUE(has("recorded_frames.png"));
    fs::remove_all(folder_ / "data");
    const Execution without = planned("");
    EXPECT_EQ(without.exitCode, 0);
    EXPECT_NE(without.output.find("warning: recorded frames not compared"), std::string::npos);
    EXPECT_FALSE(result_.contains("recorded_frames"));
    EXPECT_FALSE(has("recorded_frames.png"));
}

TEST_F(RecordedMap, WithoutGreyValuesItPlansWithoutViews) {
    const Execution run = planned(" --set map.file=" + path("map/map.bt"));
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_NE(run.output.find("map.bt: no cell of the map has a grey value"), std::string::npos);
    EXPECT_EQ(result_["views"], 0);
    EXPECT_FALSE(result_["path"].empty());
    EXPECT_FALSE(has("information.png"));
    EXPECT_TRUE(json::parse(std::ifstream(folder_ / "result" / "report.json"))["views"].empty());
}

}  // namespace
}  // namespace photonav
