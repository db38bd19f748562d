// SPDX-License-Identifier: BSD-3-Clause
// `photonav explore`, run as a user runs it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/executable.hpp"
#include "map/octree_file.hpp"
#include "recording/sequence_tum.hpp"
#include "recording/trajectory.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A small image, coarse views, few vertices and a short way.
const std::string kQuickExploration =
    " --set camera.width=94 --set camera.height=60 --set planner.view_pitch=0.5"
    " --vertices 100 --shortcut 20 --resolution 0.1 --set goal=[1,2,2] ";

class ExploreCommand : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    Execution explore(const std::string& name, const std::string& arguments) const {
        return photonav(fmt::format("explore {} {} {} --out {}", config("two_textures"),
                                    kQuickExploration, arguments, at(name)));
    }

    json result(const std::string& name) const {
        return json::parse(std::ifstream(folder_ / name / "result.json"));
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST_F(ExploreCommand, ArrivesAndWritesWhatScriptsRead) {
    const Execution run = explore("a", "");
    ASSERT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("arrived after"), std::string::npos) << run.output;
    const json a = result("a");
    EXPECT_EQ(a["command"], "explore");
    EXPECT_EQ(a["arrived"], true);
    EXPECT_EQ(a["collisions"], 0);
    for (const char* key : {"duration_s", "length", "goal_error_m", "position_rmse_m",
                            "nees_per_dof", "times_lost", "lost_s"}) {
        EXPECT_TRUE(a[key].is_number()) << key;
    }
    EXPECT_GT(a["path_trace"].size(), 5U);
    ASSERT_GT(a["updates"].size(), 3U);
    for (const char* key : {"time", "vertices_invalidated", "edges_invalidated", "vertices_added",
                            "vertices_rewired", "views_marked", "views_rendered", "fuse_ms",
                            "clearance_ms", "views_ms", "plan_ms", "cost", "length"}) {
        EXPECT_TRUE(a["updates"][1][key].is_number()) << key;
    }
    EXPECT_EQ(a["trials"].size(), 1U);
    EXPECT_EQ(a["summary"][0]["arrived"], 1);
    for (const char* name : {"report.html", "map.png", "top_view.png", "trace.png", "config.yaml",
                             "trajectory.cov", "trajectory.ov"}) {
        EXPECT_TRUE(fs::exists(folder_ / "a" / name)) << name;
    }
    EXPECT_EQ(readTrajectory(at("a/trajectory.tum")).size(),
              readTrajectory(at("a/groundtruth.tum")).size());
    EXPECT_GT(loadTexturedOcTree(at("a/map.ot"))->size(), 100U);
}

TEST_F(ExploreCommand, ComparesPlannersAndRepeatsFromItsConfig) {
    const Execution run = explore("a", "--planners rrt_star,pa_rrt_star --trials 2 --seed 3");
    ASSERT_NE(run.exitCode, 2) << run.output;
    const json a = result("a");
    ASSERT_EQ(a["trials"].size(), 4U);
    EXPECT_EQ(a["trials"][2]["planner"], "pa_rrt_star");
    EXPECT_EQ(a["trials"][3]["seed"], 4);
    ASSERT_EQ(a["summary"].size(), 2U);
    EXPECT_EQ(a["summary"][1]["flights"], 2);
    const Execution again =
        photonav(fmt::format("explore {} --jobs 2 --out {}", at("a/config.yaml"), at("b")));
    ASSERT_EQ(again.exitCode, run.exitCode) << again.output;
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(result("b")["trials"][i]["goal_error_m"], a["trials"][i]["goal_error_m"]);
    }
}

TEST_F(ExploreCommand, SaysWhyItDidNotArrive) {
    const Execution run = explore("a", "--time-limit 2");
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_NE(run.output.find("out of time"), std::string::npos) << run.output;
    EXPECT_EQ(result("a")["arrived"], false);
    EXPECT_EQ(result("a")["status"], "not arrived: the time limit was reached");
    EXPECT_TRUE(fs::exists(folder_ / "a/report.html"));
}

TEST_F(ExploreCommand, RecordsTheFlight) {
    const Execution run = explore("a", "--time-limit 2 --record " + at("flight"));
    ASSERT_NE(run.exitCode, 2) << run.output;
    const Sequence flight = readTumSequence(at("flight"));
    EXPECT_GE(flight.frames.size(), result("a")["images"].get<std::size_t>());
    EXPECT_GT(flight.frames.size(), 4U);
    const Execution again = explore("b", "--time-limit 2 --record " + at("flight"));
    EXPECT_EQ(again.exitCode, 2);
    EXPECT_NE(again.output.find("holds a recording already"), std::string::npos) << again.output;
    EXPECT_FALSE(fs::exists(folder_ / "b"));
}

TEST_F(ExploreCommand, RefusesBadInputInOneLine) {
    const auto refuses = [&](const std::string& arguments, const std::string& reason) {
        const Execution run = explore("bad", arguments);
        EXPECT_EQ(run.exitCode, 2) << arguments;
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
        EXPECT_FALSE(fs::exists(folder_ / "bad"));
    };
    refuses("--set goal=[100,2,2]", "goal: outside the bounds");
    refuses("--planners none_such", "explore.planners: 'none_such' is not one of");
    refuses("--planners rrt_star/sometimes", "the policy 'sometimes' is not one of fixed");
    refuses("--planners rrt_star/fixed", "rrt_star/fixed: the robot's heading is not free");
    refuses("--set explore.sensor=sonar", "explore.sensor");
    refuses("--set explore.vertex=3", "did you mean 'vertices'");
    refuses("--set fly.rate=-1", "fly.rate");
}

}  // namespace
}  // namespace photonav
