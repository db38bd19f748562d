// SPDX-License-Identifier: BSD-3-Clause
// `photonav sweep`, run as a user runs it: threads, shards, interruptions, bad input.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/executable.hpp"
#include "io/folder_transaction.hpp"
#include "journal_text.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Small, coarse views and few vertices: 8 runs take less than a second.
const std::string kQuickProblem =
    " --set planner.vertices=120 --set planner.view_pitch=0.5 --set camera.width=94"
    " --set camera.height=60 ";
const std::string kQuickSweep =
    kQuickProblem + "--alpha 0.1,0.6 --runs 2 --planners pa_rrt_star,rrt_star ";

class SweepCommand : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    Execution sweep(const std::string& name, const std::string& arguments,
                    const std::string& settings = kQuickSweep) const {
        return photonav(fmt::format("sweep {} {} {} --out {}", config("two_textures"), settings,
                                    arguments, at(name)));
    }

    json result(const std::string& name) const {
        return json::parse(test::contentOf(folder_ / name / "result.json"));
    }

    /// The runs, without what depends on the machine.
    json runs(const std::string& name) const {
        json runs = result(name)["runs"];
        for (json& run : runs) run.erase("seconds");
        return runs;
    }

    /// Leaves the first `count` runs of a finished sweep, and half of the next.
    /// @return the lines left whole
    std::string cutAfter(const std::string& name, int count) const {
        const fs::path file = folder_ / name / "runs.jsonl";
        std::ifstream stream(file);
        std::ostringstream whole;
        std::string line;
        for (int i = 0; i <= count && std::getline(stream, line); ++i) whole << line << '\n';
        std::getline(stream, line);
        std::ofstream(file, std::ios::trunc) << whole.str() << line.substr(0, 40);
        fs::remove(folder_ / name / "result.json");
        return whole.str();
    }

    /// As a sweep is when it was killed after `count` runs. @return the lines left whole
    std::string killAfter(const std::string& name, int count) const {
        const std::string kept = cutAfter(name, count);
        const fs::path unfinished = folder_ / (name + ".unfinished");
        fs::create_directories(unfinished);
        std::ofstream(unfinished / Manifest::kFileName);  // the lock
        fs::rename(folder_ / name / "runs.jsonl", unfinished / "runs.jsonl");
        fs::remove_all(folder_ / name);
        return kept;
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST_F(SweepCommand, WritesEverythingItPromises) {
    std::ofstream(at("best.csv")) << "alpha,cost,seed\n0.1,2.5,1\n";
    const Execution run = sweep("out", fmt::format("--set sweep.reference={}", at("best.csv")));
    ASSERT_EQ(run.exitCode, 0) << run.output;
    for (const char* name :
         {"result.json", "config.yaml", "runs.jsonl", "runs.csv", "summary.csv", "sweep.png",
          "sweep.svg", "pareto.png", "paths.png", "report.json", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_ / "out" / name)) << name;
    }
    const json r = result("out");
    ASSERT_EQ(r["runs"].size(), 8U);
    EXPECT_EQ(r["status"], "done");
    for (const char* key : {"planner", "alpha", "seed", "cost", "length", "mean_trace",
                            "goal_trace", "vertices", "views", "seconds", "excess", "status"}) {
        EXPECT_TRUE(r["runs"][0].contains(key)) << key;
    }
    const json& first = r["runs"][0];
    EXPECT_EQ(first["planner"], "pa_rrt_star");
    EXPECT_EQ(first["seed"], 1);
    EXPECT_NEAR(first["excess"].get<double>(), first["cost"].get<double>() / 2.5 - 1., 1e-12);
    EXPECT_TRUE(r["runs"][2]["excess"].is_null());  // no reference for alpha 0.6
    ASSERT_EQ(r["summary"].size(), 4U);
    EXPECT_NEAR(r["summary"][0]["length_mean"].get<double>(),
                0.5 * (first["length"].get<double>() + r["runs"][1]["length"].get<double>()),
                1e-12);
    EXPECT_TRUE(r["summary"][0]["paper_length"].is_null());  // the paper has no alpha 0.1
    const std::string csv = test::contentOf(folder_ / "out/runs.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 9);
    EXPECT_NE(run.output.find("pa_rrt_star"), std::string::npos);
}

TEST_F(SweepCommand, EveryPathIsJudgedByTheSweepsAlpha) {
    ASSERT_EQ(sweep("out", "").exitCode, 0);
    const json r = result("out");
    for (const json& run : r["runs"]) {
        if (run["planner"] != "rrt_star") continue;
        const double alpha = run["alpha"];
        const double length = run["length"];
        // J = alpha length + (1 - alpha) kappa (mean trace) length
        EXPECT_NEAR(run["cost"].get<double>(),
                    length * (alpha + (1. - alpha) * 2.5 * run["mean_trace"].get<double>()), 1e-9);
        EXPECT_EQ(run["views"], 0);
    }
}

TEST_F(SweepCommand, AgreesWithPlanAndDoesNotDependOnThreads) {
    ASSERT_EQ(sweep("one", "--jobs 1").exitCode, 0);
    ASSERT_EQ(sweep("three", "--jobs 3").exitCode, 0);
    EXPECT_EQ(runs("one"), runs("three"));
    ASSERT_EQ(
        photonav(fmt::format("plan {} {} --set planner.alpha=0.6 --set planner.name=pa_rrt_star "
                             "--seed 2 --out {}",
                             config("two_textures"), kQuickProblem, at("plan")))
            .exitCode,
        0);
    const json plan = result("plan");
    const json run = runs("one")[3];
    for (const char* key :
         {"alpha", "seed", "cost", "length", "mean_trace", "goal_trace", "vertices", "views"}) {
        EXPECT_EQ(run[key], plan[key]) << key;
    }
}

TEST_F(SweepCommand, ShardsMergeToTheWhole) {
    ASSERT_EQ(sweep("whole", "").exitCode, 0);
    ASSERT_EQ(sweep("a", "--shard 1/2").exitCode, 0);
    ASSERT_EQ(sweep("b", "--shard 2/2").exitCode, 0);
    const Execution merge =
        photonav(fmt::format("sweep --merge {} {} --out {}", at("b"), at("a"), at("merged")));
    ASSERT_EQ(merge.exitCode, 0) << merge.output;
    EXPECT_EQ(runs("merged"), runs("whole"));
    EXPECT_EQ(test::contentOf(folder_ / "merged/config.yaml"),
              test::contentOf(folder_ / "whole/config.yaml"));
    const Execution named =
        photonav(fmt::format("sweep {} {} --merge {} {} --out {}", config("two_textures"),
                             kQuickSweep, at("a"), at("b"), at("named")));
    ASSERT_EQ(named.exitCode, 0) << named.output;
    EXPECT_EQ(runs("named"), runs("whole"));
}

TEST_F(SweepCommand, ShardsThatDoNotMatchAreRefused) {
    const std::string quick =
        " --set planner.vertices=150 --alpha 0.5 --runs 3 --planners rrt_star ";
    ASSERT_EQ(sweep("1of2", "--shard 1/2", quick).exitCode, 0);
    ASSERT_EQ(sweep("2of2", "--shard 2/2", quick).exitCode, 0);
    ASSERT_EQ(sweep("2of3", "--shard 2/3", quick).exitCode, 0);
    ASSERT_EQ(sweep("other", "--shard 2/2 --set planner.range=1.5", quick).exitCode, 0);
    // A result of its own, as an earlier merge left it.
    ASSERT_EQ(sweep("m", "", quick).exitCode, 0);
    const std::string before = test::contentOf(folder_ / "m/runs.jsonl");
    const auto merge = [&](const std::vector<std::string>& names, const std::string& out = "m") {
        std::ostringstream arguments;
        arguments << "sweep --out " << at(out) << " --merge";
        for (const std::string& name : names) arguments << ' ' << at(name);
        return photonav(arguments.str());
    };
    expectBadInput(merge({"1of2"}), "shard 2/2: missing");
    expectBadInput(sweep("none", "--shard 9/4000000000", quick), "--shard: 9/4000000000: of ");
    expectBadInput(merge({"1of2", "1of2"}), "is shard 1/2, as is ");
    expectBadInput(merge({"1of2", "2of3"}), "is shard 2/3");
    expectBadInput(merge({"1of2", "other"}), "planner.range: 1.5 instead of 0");
    expectBadInput(merge({"1of2", "nowhere"}), "is this a sweep?");
    expectBadInput(merge({"1of2", "2of2"}, "2of2"), "the result needs another folder");
    expectBadInput(photonav(fmt::format("sweep {} --merge {} {} --out {}", config("two_textures"),
                                        at("1of2"), at("2of2"), at("m"))),
                   "instead of");
    {
        const FolderTransaction running(folder_ / "2of2");
        expectBadInput(merge({"1of2", "2of2"}), "2of2: another photonav is writing it");
    }
    cutAfter("2of2", 0);
    expectBadInput(merge({"1of2", "2of2"}), "1 runs are missing");
    expectBadInput(merge({"1of2", "2of2"}, "new"), "1 runs are missing");
    EXPECT_FALSE(fs::exists(folder_ / "new"));
    for (const char* kept : {"result.json", "runs.csv", "summary.csv", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_ / "m" / kept)) << kept;
    }
    EXPECT_EQ(test::contentOf(folder_ / "m/runs.jsonl"), before);
}

TEST_F(SweepCommand, ShardsWithAnotherResultOfTheSameRunAreRefused) {
    const std::string quick =
        " --set planner.vertices=150 --alpha 0.5 --runs 2 --planners rrt_star ";
    ASSERT_EQ(sweep("a", "--shard 1/2", quick).exitCode, 0);
    ASSERT_EQ(sweep("b", "--shard 2/2", quick).exitCode, 0);
    const auto linesOf = [&](const char* name) {
        return test::withoutChecksums(test::contentOf(folder_ / name / "runs.jsonl"));
    };
    const std::string a = linesOf("a"), b = linesOf("b");
    const auto merge = [&](const std::string& more) {
        test::writeJournal(folder_ / "b/runs.jsonl", b + more);
        return photonav(fmt::format("sweep --merge {} {} --out {}", at("a"), at("b"), at("m")));
    };
    json run = json::parse(a.substr(a.find('\n') + 1));
    run["seconds"] = 1e3;
    EXPECT_EQ(merge(run.dump() + "\n").exitCode, 0);
    fs::remove_all(folder_ / "m");
    run["goal_trace"] = 1.;
    expectBadInput(merge(run.dump() + "\n"),
                   fmt::format("photonav: --merge: {}/runs.jsonl: rrt_star alpha 0.5 seed 1: has "
                               "another result in {}/runs.jsonl\n",
                               at("b"), at("a")));
    EXPECT_FALSE(fs::exists(folder_ / "m"));
}

TEST_F(SweepCommand, TheConfigOfShardsIsReadFromTheirJournal) {
    ASSERT_EQ(sweep("a", "").exitCode, 0);
    std::string journal = test::withoutChecksums(test::contentOf(folder_ / "a/runs.jsonl"));
    const std::string good = "vertices: 120", bad = "vertices: -12";
    ASSERT_NE(journal.find(good), std::string::npos);
    const std::string merge = fmt::format("--merge {} --out {}", at("a"), at("m"));
    EXPECT_EQ(execute(fmt::format("TMPDIR=/nowhere {} sweep {}", PHOTONAV_BINARY, merge)).exitCode,
              0);
    fs::remove_all(folder_ / "m");
    test::writeJournal(folder_ / "a/runs.jsonl", journal.replace(journal.find(good), 13, bad));
    const Execution run = photonav("sweep " + merge);
    expectBadInput(run, fmt::format("photonav: {}/runs.jsonl: planner.vertices: ", at("a")));
    EXPECT_FALSE(fs::exists(folder_ / "m"));
}

TEST_F(SweepCommand, AKilledSweepResumesWhereItWas) {
    ASSERT_EQ(sweep("out", "").exitCode, 0);
    const json whole = runs("out");
    const std::string kept = killAfter("out", 5);
    expectBadInput(sweep("out", ""), "out.unfinished: holds 5 runs of a sweep that did not end");
    ASSERT_EQ(sweep("out", "--resume --jobs 2").exitCode, 0);
    EXPECT_FALSE(fs::exists(folder_ / "out.unfinished"));
    EXPECT_EQ(runs("out"), whole);
    EXPECT_TRUE(test::contentOf(folder_ / "out/runs.jsonl").starts_with(kept));  // not run again
    const Execution fresh = sweep("fresh", "--resume");  // nothing there: from the start
    ASSERT_EQ(fresh.exitCode, 0);
    EXPECT_NE(fresh.output.find("fresh: nothing there yet; the sweep begins anew"),
              std::string::npos)
        << fresh.output;
    EXPECT_EQ(runs("fresh"), whole);
}

TEST_F(SweepCommand, AResultOfAnotherCommandIsNotResumed) {
    const std::string info =
        fmt::format("info {} --cells 2 --quiet --out {}", config("two_textures"), at("out"));
    ASSERT_EQ(photonav(info).exitCode, 0);
    const std::string kept = test::contentOf(folder_ / "out/result.json");
    expectBadInput(sweep("out", "--resume"), "out: holds a result, but not a sweep to go on with");
    EXPECT_EQ(test::contentOf(folder_ / "out/result.json"), kept);
}

TEST_F(SweepCommand, AResumedSweepMustBeTheSame) {
    const std::string quick =
        " --set planner.vertices=150 --alpha 0.5 --runs 2 --planners rrt_star --resume ";
    ASSERT_EQ(sweep("out", "", quick).exitCode, 0);
    expectBadInput(sweep("out", "--set camera.sigma=0.03", quick),
                   "camera.sigma: 0.03 instead of 0.02");
    expectBadInput(sweep("out", "--shard 1/2", quick), "holds shard 1/1, not 1/2");
    EXPECT_EQ(result("out")["runs"].size(), 2U);  // still there
}

TEST_F(SweepCommand, AResumedSweepMayAskForOtherRuns) {
    const std::string quick = " --set planner.vertices=150 --planners rrt_star --resume ";
    ASSERT_EQ(sweep("out", "--alpha 0.5,0.7 --runs 2", quick).exitCode, 0);
    const json first = runs("out");
    const std::string kept = test::contentOf(folder_ / "out/runs.jsonl");
    const std::string wanted = "--alpha 0.3,0.5 --runs 3 --seed 2";
    ASSERT_EQ(sweep("out", wanted, quick).exitCode, 0);
    ASSERT_EQ(sweep("fresh", wanted, quick).exitCode, 0);
    EXPECT_EQ(runs("out"), runs("fresh"));
    EXPECT_EQ(runs("out")[3], first[1]);  // alpha 0.5, seed 2
    EXPECT_EQ(test::contentOf(folder_ / "out/config.yaml"),
              test::contentOf(folder_ / "fresh/config.yaml"));
    const std::string all = test::contentOf(folder_ / "out/runs.jsonl");
    const std::string done = kept.substr(kept.find('\n'));     // behind the header
    EXPECT_EQ(all.substr(all.find('\n'), done.size()), done);  // not run again, none forgotten
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 1 + 4 + 5);
}

TEST_F(SweepCommand, CtrlCAndALimitOfProcessorTimeKeepTheRunsDone) {
    for (const auto& [signal, exitCode] : {std::pair{"INT", 130}, {"XCPU", 152}}) {
        // Interrupted as soon as the header and two runs are there.
        const std::string out = at(signal);
        const Execution run = interrupt(
            fmt::format("{} sweep {} --set planner.vertices=150 --alpha 0.5 --runs 1000000"
                        " --planners rrt_star --quiet --out {}",
                        PHOTONAV_BINARY, config("two_textures"), out),
            fmt::format("[ $(cat {}.unfinished/runs.jsonl 2>/dev/null | wc -l) -gt 2 ]", out), 0.,
            signal);
        EXPECT_EQ(run.exitCode, exitCode) << run.output;
        const json r = result(signal);
        EXPECT_EQ(r["status"], "interrupted");
        EXPECT_EQ(r["runs"].size(), r["runs_done"]);
        EXPECT_GE(r["runs"].size(), 2U);
        EXPECT_LT(r["runs"].size(), 1000000U);
    }
}

TEST_F(SweepCommand, CtrlCLeavesAnEarlierResultOfMoreRuns) {
    const std::string common = fmt::format(
        "sweep {} --set planner.vertices=400 --alpha 0.5 --planners rrt_star --quiet --out {}",
        config("two_textures"), at("out"));
    ASSERT_EQ(photonav(common + " --runs 40").exitCode, 0);
    const json whole = result("out");
    const Execution run = interrupt(
        fmt::format("{} {} --runs 1000000", PHOTONAV_BINARY, common),
        fmt::format("[ $(cat {}.unfinished/runs.jsonl 2>/dev/null | wc -l) -gt 1 ]", at("out")));
    EXPECT_EQ(run.exitCode, 130) << run.output;
    EXPECT_NE(run.output.find("stays; --resume goes on with"), std::string::npos) << run.output;
    EXPECT_EQ(result("out"), whole);
    EXPECT_EQ(photonav(common + " --runs 40").exitCode, 2);  // its runs are not lost, either
    EXPECT_EQ(photonav(common + " --runs 40 --resume").exitCode, 0);
    EXPECT_EQ(result("out")["runs"].size(), 40U);
}

TEST_F(SweepCommand, CtrlCLeavesAnEarlierResultOfOtherRuns) {
    const std::string common =
        fmt::format("sweep {} --alpha 0.5 --planners rrt_star --quiet --out {}",
                    config("two_textures"), at("out"));
    ASSERT_EQ(photonav(common + " --set planner.vertices=150 --runs 1").exitCode, 0);
    const json whole = result("out");
    const std::string other = common + " --set planner.vertices=151 --runs ";
    const Execution run = interrupt(
        fmt::format("{} {} 1000000", PHOTONAV_BINARY, other),
        fmt::format("[ $(cat {}.unfinished/runs.jsonl 2>/dev/null | wc -l) -gt 2 ]", at("out")));
    EXPECT_EQ(run.exitCode, 130) << run.output;
    EXPECT_EQ(result("out"), whole);
    EXPECT_EQ(photonav(other + "2 --resume").exitCode, 0);
    EXPECT_EQ(result("out")["runs"].size(), 2U);
}

TEST_F(SweepCommand, ItsPageShowsCurvesAndTables) {
#ifdef PHOTONAV_SANITIZED
    GTEST_SKIP() << "the page runs in the browser, not under the sanitizers";
#endif
    constexpr const char* kBrowser = "/usr/bin/chromium";
    if (!fs::exists(kBrowser)) GTEST_SKIP() << kBrowser << " is not installed";
    ASSERT_EQ(sweep("out",
                    "--set \"sweep.paper=[{alpha: 0.6, length: 9, mean_trace: 4.25,"
                    " goal_trace: 1}]\"")
                  .exitCode,
              0);
    const Execution page = execute(fmt::format(
        "{} --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader"
        " --no-first-run --virtual-time-budget=8000 --user-data-dir={} --dump-dom file://{}",
        kBrowser, at("profile"), at("out/report.html")));
    EXPECT_NE(page.output.find("<section class=\"charts\" id=\"sweep-charts\">"),
              std::string::npos);  // not hidden
    EXPECT_NE(page.output.find("</span>pa_rrt_star</h2>"), std::string::npos);
    EXPECT_NE(page.output.find("<td class=\"quiet\">0.0425"),
              std::string::npos);  // the paper's
    EXPECT_NE(page.output.find("<td>2 of 2</td>"), std::string::npos);
    EXPECT_EQ(page.output.find("data-errors"), std::string::npos);
}

TEST_F(SweepCommand, EveryPlannerReportsAnUnreachableGoal) {
    std::ofstream(at("walled.yaml"))
        << "textures:\n  - {name: grey, type: uniform, grey: 0.5}\n"
           "planes:\n  - {corner: [-4, -4, 0], u: [16, 0, 0], v: [0, 16, 0], texture: grey}\n"
           "walls:\n  - {footprint: [[-4, 5], [12, 5]], height: 4, thickness: 0.2, texture: "
           "grey}\n";
    const Execution run = sweep("out", fmt::format("--set scene.file={}", at("walled.yaml")),
                                " --set planner.vertices=60 --alpha 0.5,0.7 --runs 2"
                                " --planners belief_rrt_star,pa_rrt_star,rrt_star ");
    EXPECT_EQ(run.exitCode, 1) << run.output;
    const json r = result("out");
    EXPECT_EQ(r["status"], "no path");
    ASSERT_EQ(r["runs"].size(), 12U);
    ASSERT_EQ(r["summary"].size(), 6U);
    for (const json& entry : r["runs"]) {
        EXPECT_EQ(entry["status"], "no path: the goal was not reached by 60 vertices");
        EXPECT_TRUE(entry["cost"].is_null());
        EXPECT_EQ(entry["vertices"], 60);
    }
    EXPECT_TRUE(fs::exists(folder_ / "out/report.html"));
    EXPECT_EQ(run.output.find("paper"), std::string::npos) << run.output;  // beside nothing of ours
    for (const char* planner : {"belief_rrt_star", "pa_rrt_star", "rrt_star"}) {
        const auto line = fmt::format(
            "\n{}: no path: the goal was not reached by 60 vertices (4 runs)\n", planner);
        EXPECT_NE(run.output.find(line), std::string::npos) << run.output;
    }
}

TEST_F(SweepCommand, BadInputIsOneLineAndExitCodeTwo) {
    expectBadInput(sweep("out", "--planners rrt_star,rrt_sta", " "),
                   "'rrt_sta' is not one of belief_rrt_star, pa_rrt_star, rrbt, rrt_star");
    expectBadInput(sweep("out", "--alpha 0:1", " "), "--alpha: expected first:last:step");
    expectBadInput(sweep("out", "--alpha 0.5,1.5", " "), "1.5 is outside [0, 1]");
    expectBadInput(sweep("out", "--shard 3/2", " "), "--shard: '3/2' is not k/n");
    expectBadInput(sweep("out", "--runs 0", " "), "sweep.runs");
    expectBadInput(sweep("out", "--seed 4294967295 --runs 2", " "),
                   "2 runs from 4294967295 on go beyond the last seed");
    expectBadInput(sweep("out", "--jobs 0", " "), "--jobs");
    expectBadInput(sweep("out", "--set sweep.reference=nowhere.csv", " "), "nowhere.csv");
    expectBadInput(photonav("sweep"), "give a CONFIG");
    expectBadInput(photonav("sweep --merge a --resume"), "--merge");
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace photonav
