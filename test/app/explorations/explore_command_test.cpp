// SPDX-License-Identifier: BSD-3-Clause
// `photonav explore`, run as a user runs it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/executable.hpp"
#include "app/explorations/quick_exploration.hpp"
#include "dataset/sequence_tum.hpp"
#include "dataset/trajectory.hpp"
#include "io/folder_transaction.hpp"
#include "map/octree_file.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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

    /// Edge of the cubes of the map that a report draws.
    json drawnCells(const std::string& name) const {
        return json::parse(std::ifstream(folder_ / name / "flight.json"))["header"]["cell"];
    }

    /// All that was flown, without what depends on the machine.
    json flown(const std::string& name) const {
        json whole = result(name);
        whole.erase("time");
        const auto withoutTimes = [](json& flight) {
            flight.erase("wall_s");
            for (json& update : flight["updates"]) {
                for (const char* key : {"fuse_ms", "clearance_ms", "views_ms", "plan_ms"}) {
                    update.erase(key);
                }
            }
        };
        withoutTimes(whole);
        for (json& flight : whole["trials"]) withoutTimes(flight);
        for (json& summary : whole["summary"]) {
            for (const char* key : {"update_median_ms", "update_95_percent_ms"}) summary.erase(key);
        }
        return whole;
    }

    std::string fileOf(const std::string& name, const std::string& file) const {
        return test::contentOf(folder_ / name / file);
    }

    /// Everything but what depends on the machine.
    void expectSame(const std::string& name, const std::string& other) const {
        EXPECT_EQ(flown(name), flown(other));
        for (const char* file : {"config.yaml", "map.ot", "trajectory.tum", "trajectory.cov",
                                 "groundtruth.tum", "map.png", "top_view.png"}) {
            EXPECT_TRUE(fileOf(name, file) == fileOf(other, file)) << file;
        }
    }

    /// As an exploration is when it was killed after `count` flights: these, and half of the next.
    void killAfter(const std::string& name, std::size_t count) const {
        const fs::path unfinished = folder_ / (name + ".unfinished");
        fs::create_directories(unfinished);
        std::ofstream(unfinished / Manifest::kFileName);  // the lock
        std::istringstream lines(fileOf(name, "trials.jsonl"));
        std::ofstream kept(unfinished / "trials.jsonl");
        std::string line;
        for (std::size_t i = 0; i <= count && std::getline(lines, line); ++i) kept << line << '\n';
        if (std::getline(lines, line)) kept << line.substr(0, 40);
        if (count > 0) fs::rename(folder_ / name / "map.ot", unfinished / "map.ot");
        fs::remove_all(folder_ / name);
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
    const json table = json::parse(test::contentOf(at("a/report.json")))["text_tables"][0];
    EXPECT_EQ(table["head"].size(), 9U);
    EXPECT_EQ(table["rows"].size(), a["updates"].size());
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
    for (const char* inside : {"b", "b/flight", "."}) {
        expectBadInput(explore("b", std::string("--record ") + at(inside)), "need to be apart");
    }
    EXPECT_FALSE(fs::exists(folder_ / "b"));
}

const std::string kThreeFlights = " --planners rrt_star --trials 3 --time-limit 3 ";

TEST_F(ExploreCommand, AKilledExplorationResumesWhereItWas) {
    ASSERT_EQ(explore("whole", kThreeFlights).exitCode, 1);  // out of time
    for (const std::size_t ended : {0U, 1U, 2U}) {
        fs::copy(folder_ / "whole", folder_ / "out", fs::copy_options::recursive);
        killAfter("out", ended);
        const std::string kept = fileOf("out.unfinished", "trials.jsonl");
        if (ended == 2) {
            expectBadInput(explore("out", kThreeFlights),
                           "out.unfinished: holds 2 flights of an exploration that did not end");
        }
        const Execution resumed = explore("out", kThreeFlights + "--resume --jobs 2");
        ASSERT_EQ(resumed.exitCode, 1) << resumed.output;
        expectSame("out", "whole");
        const std::string whole = kept.substr(0, kept.rfind('\n') + 1);
        EXPECT_TRUE(fileOf("out", "trials.jsonl").starts_with(whole));  // not flown again
        EXPECT_FALSE(fs::exists(folder_ / "out.unfinished"));
        fs::remove_all(folder_ / "out");
    }
}

TEST_F(ExploreCommand, AnEndedExplorationIsExtended) {
    const std::string quick = " --time-limit 2 --resume ";
    ASSERT_EQ(explore("out", quick + "--planners rrt_star --trials 2").exitCode, 1);
    const std::string kept = fileOf("out", "trials.jsonl");
    const std::string wanted = quick + "--planners pa_rrt_star,rrt_star --trials 2 --seed 2";
    ASSERT_EQ(explore("out", wanted).exitCode, 1);
    ASSERT_EQ(explore("fresh", wanted).exitCode, 1);
    expectSame("out", "fresh");  // with the map of another flight than before
    const std::string all = fileOf("out", "trials.jsonl");
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 1 + 2 + 3);  // of five, one was there
    expectBadInput(explore("out", wanted + " --set camera.sigma=0.03"),
                   "the exploration was begun with another config: camera.sigma: 0.03 instead of");
    expectBadInput(explore("out", wanted + " --shard 1/2"), "holds shard 1/1, not 1/2");
    expectBadInput(explore("out", wanted + " --record " + at("flight")),
                   "--record: the first flight is finished");
    EXPECT_EQ(result("out")["trials"].size(), 4U);  // still there
}

TEST_F(ExploreCommand, ShardsMergeToTheWhole) {
    ASSERT_EQ(explore("whole", kThreeFlights).exitCode, 1);
    ASSERT_EQ(explore("1of2", kThreeFlights + "--shard 1/2").exitCode, 1);
    ASSERT_EQ(explore("2of2", kThreeFlights + "--shard 2/2").exitCode, 1);
    ASSERT_EQ(explore("other", kThreeFlights + "--shard 2/2 --commitment 0.2").exitCode, 1);
    EXPECT_EQ(result("1of2")["trials"].size(), 2U);
    EXPECT_EQ(result("2of2")["trials"][0]["seed"], 2);
    const auto merge = [&](const std::string& first, const std::string& second,
                           const std::string& more = "") {
        return photonav(fmt::format("explore --merge {} {} --out {} {}", at(first), at(second),
                                    at("merged"), more));
    };
    const Execution merged = merge("2of2", "1of2");
    ASSERT_EQ(merged.exitCode, 1) << merged.output;
    expectSame("merged", "whole");

    expectBadInput(merge("1of2", "1of2"), "is shard 1/2, as is ");
    expectBadInput(merge("1of2", "other"), "explore.commitment: 0.2 instead of 0.1");
    expectBadInput(merge("1of2", "nowhere"), "is this an exploration?");
    expectBadInput(merge("1of2", "merged"), "is shard 1/1");
    expectBadInput(merge("1of2", "2of2", "--resume"), "goes without --shard and --resume");
    expectBadInput(merge("1of2", "2of2", "--record " + at("flight")), "goes without --record");
    expectBadInput(photonav("explore --merge " + at("1of2") + " --out " + at("new")),
                   "shard 2/2: missing");
    {
        const FolderTransaction running(folder_ / "2of2");
        expectBadInput(merge("1of2", "2of2"), "2of2: another photonav is writing it");
    }
    fs::rename(folder_ / "1of2/map.ot", folder_ / "map.ot");
    expectBadInput(merge("1of2", "2of2"), "the map of its first flight is missing");
    fs::rename(folder_ / "map.ot", folder_ / "1of2/map.ot");
    const std::string flights = fileOf("2of2", "trials.jsonl");
    std::ofstream(folder_ / "2of2/trials.jsonl") << flights.substr(0, flights.find('\n') + 40);
    expectBadInput(merge("1of2", "2of2"), "1 flights are missing; finish it with --resume");
    EXPECT_EQ(result("merged")["trials"].size(), 3U);  // still there
}

TEST_F(ExploreCommand, CtrlCKeepsTheFlightsThatEnded) {
    const std::string common = fmt::format("explore {} {} --planners rrt_star --time-limit 2",
                                           config("two_textures"), kQuickExploration);
    // Interrupted as soon as the header and two flights are there.
    const Execution run = interrupt(
        fmt::format("{} {} --trials 1000000 --out {}", PHOTONAV_BINARY, common, at("out")),
        fmt::format("[ $(cat {}.unfinished/trials.jsonl 2>/dev/null | wc -l) -gt 2 ]", at("out")));
    EXPECT_EQ(run.exitCode, 130) << run.output;
    EXPECT_NE(run.output.find(" of 1000000 flights ended and are kept"), std::string::npos)
        << run.output;
    const json r = result("out");
    EXPECT_EQ(r["status"], "interrupted");
    EXPECT_GE(r["trials"].size(), 2U);
    EXPECT_EQ(r["trials"].size(), r["flights_ended"]);
    for (const json& flight : r["trials"]) EXPECT_EQ(flight["end"], "out of time");
    const auto again =
        fmt::format("{} --trials {} --resume --out {}", common, r["trials"].size(), at("out"));
    EXPECT_EQ(photonav(again).exitCode, 1);
    EXPECT_EQ(result("out")["trials"], r["trials"]);  // not flown again
}

TEST_F(ExploreCommand, AFirstFlightThatIsInterruptedIsReportedNotKept) {
    const Execution run = interrupt(
        fmt::format("{} explore {} {} --set goal=[2,9,2] --planners rrt_star --out {}",
                    PHOTONAV_BINARY, config("two_textures"), kQuickExploration, at("out")),
        fmt::format("[ -s {}.unfinished/trials.jsonl ]", at("out")));
    EXPECT_EQ(run.exitCode, 130) << run.output;
    EXPECT_EQ(result("out")["trials"][0]["end"], "stopped");
    EXPECT_EQ(result("out")["flights_ended"], 0);
    const std::string kept = fileOf("out", "trials.jsonl");
    EXPECT_EQ(std::count(kept.begin(), kept.end(), '\n'), 1);
}

TEST_F(ExploreCommand, KnowsTheMapOfAnEarlierFlight) {
    ASSERT_EQ(explore("first", "").exitCode, 0);
    const std::string known = "--set map.file=" + at("first/map.ot");
    const Execution run = explore("second", known);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    EXPECT_LT(result("second")["updates"].size(), result("first")["updates"].size());
    EXPECT_EQ(result("second")["known_map"], at("first/map.ot"));
    EXPECT_TRUE(result("first")["known_map"].is_null());
    const Execution again =
        photonav(fmt::format("explore {} --out {}", at("second/config.yaml"), at("third")));
    ASSERT_EQ(again.exitCode, 0) << again.output;
    EXPECT_EQ(flown("third"), flown("second"));
    const Execution asMap =
        photonav(fmt::format("explore {} {} {} --out {}", config("two_textures"), kShortExploration,
                             known, at("cells-of-map")));
    ASSERT_EQ(asMap.exitCode, 0) << asMap.output;
    EXPECT_EQ(drawnCells("cells-of-map"), drawnCells("second"));
    expectBadInput(explore("second", "--resume"), "map.file: nothing instead of map.ot");
    expectBadInput(explore("first", known), "which this run reads; give another folder");
    for (const char* command : {"plan", "fly", "sweep", "info"}) {
        expectBadInput(
            photonav(fmt::format("{} {} {} --out {}", command, config("two_textures"), known,
                                 at("new"))),
            "map.file: not together with scene.file: only `photonav explore` takes both");
    }
    EXPECT_FALSE(fs::exists(folder_ / "new"));
}

TEST_F(ExploreCommand, RefusesBadInputInOneLine) {
    const auto refuses = [&](const std::string& arguments, const std::string& reason) {
        const Execution run = explore("bad", arguments);
        EXPECT_EQ(run.exitCode, 2) << arguments;
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
        EXPECT_FALSE(fs::exists(folder_ / "bad"));
    };
    refuses("--set goal=[100,2,2]", "goal: [100, 2, 2] is outside the bounds");
    refuses("--planners none_such", "explore.planners: 'none_such' is not one of");
    refuses("--planners rrt_star/sometimes", "the policy 'sometimes' is not one of fixed");
    refuses("--planners rrt_star/fixed", "rrt_star/fixed: the robot's heading is not free");
    refuses("--set explore.sensor=sonar", "explore.sensor");
    refuses("--set explore.vertex=3", "did you mean 'explore.vertices'");
    refuses("--set fly.rate=-1", "fly.rate");
    refuses("--planners rrt_star,rrt_star", "explore.planners: rrt_star twice");
    refuses("--seed 4294967295 --trials 2", "2 runs from 4294967295 on go beyond the last seed");
    refuses("--shard 3/2", "--shard: '3/2' is not k/n");
    refuses("--shard 3/3 --trials 2", "--shard: 3/3: of 2 runs none");
    refuses("--jobs 0", "--jobs");
    expectBadInput(photonav("explore"), "give a CONFIG");
}

}  // namespace
}  // namespace photonav
