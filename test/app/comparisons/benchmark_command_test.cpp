// SPDX-License-Identifier: BSD-3-Clause
// `photonav benchmark`, and OMPL's own tool reading what it wrote.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/executable.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kStatistics = "/usr/bin/ompl_benchmark_statistics";
const std::string kQuickBenchmark =
    " --set planner.vertices=150 --set planner.view_pitch=0.5 --runs 2 --seed 3"
    " --planners pa_rrt_star,rrt_star ";

class BenchmarkCommand : public testing::Test {
  protected:
    Execution benchmark(const std::string& arguments) const {
        return photonav(fmt::format("benchmark {} {} --out {}", config("two_textures"), arguments,
                                    folder_.string()));
    }

    static json parsed(const fs::path& file) { return json::parse(std::ifstream(file)); }

    /// Rows of an SQL query as JSON.
    json query(const std::string& sql) const {
        const Execution run = execute(
            fmt::format("python3 -c \"import json, sqlite3; print(json.dumps(sqlite3.connect('{}')"
                        ".execute('{}').fetchall()))\"",
                        (folder_ / "benchmark.db").string(), sql));
        EXPECT_EQ(run.exitCode, 0) << run.output;
        return json::parse(run.output);
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path() / "out";
};

TEST_F(BenchmarkCommand, ItsLogIsReadByOmplsOwnTool) {
    if (!fs::exists(kStatistics)) GTEST_SKIP() << kStatistics << " (ompl-demos) is not installed";
    const Execution run = benchmark(kQuickBenchmark + "--interval 0.001");
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const Execution read =
        execute(fmt::format("{} {} -d {}", kStatistics, (folder_ / "benchmark.log").string(),
                            (folder_ / "benchmark.db").string()));
    ASSERT_EQ(read.exitCode, 0) << read.output;

    const json runs = parsed(folder_ / "result.json")["runs"];
    const json rows = query(
        "SELECT name, seed, solved, vertices, views, cost, path_length, trace_at_goal, mean_trace"
        " FROM runs JOIN plannerConfigs ON plannerid = plannerConfigs.id ORDER BY runs.id");
    ASSERT_EQ(rows.size(), 4U);
    ASSERT_EQ(runs.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(rows[i][0], i < 2 ? "geometric_pa_rrt_star" : "geometric_rrt_star");
        EXPECT_EQ(rows[i][1], 3 + i % 2);
        EXPECT_EQ(rows[i][2], 1);
        EXPECT_EQ(rows[i][3], 150);
        EXPECT_EQ(rows[i][4], runs[i]["views"]);
        std::size_t column = 5;
        for (const char* key : {"cost", "length", "goal_trace", "mean_trace"}) {
            EXPECT_NEAR(rows[i][column++].get<double>(), runs[i][key].get<double>(), 1e-6) << key;
        }
    }
    const json progress = query(
        "SELECT runid, count(*), min(best_cost), max(vertices), max(views) FROM progress"
        " GROUP BY runid ORDER BY runid");
    ASSERT_EQ(progress.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_GT(progress[i][1].get<int>(), i < 2 ? 10 : 0);  // samples
        // What the planner minimises: of rrt_star the length, before the path is shortened.
        const auto best = progress[i][2].get<double>();
        if (i < 2) {
            EXPECT_NEAR(best, runs[i]["cost"].get<double>(), 1e-6);
        } else {
            EXPECT_GT(best, runs[i]["length"].get<double>());
        }
        EXPECT_EQ(progress[i][3], 150);
        EXPECT_EQ(progress[i][4], runs[i]["views"]);
    }
    EXPECT_EQ(query("SELECT alpha, runcount FROM experiments"), json::parse("[[0.1, 2]]"));
}

TEST_F(BenchmarkCommand, ItsRunsAreThoseOfASweep) {
    const Execution run = benchmark(kQuickBenchmark + "--set planner.alpha=0.4");
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const json ours = parsed(folder_ / "result.json")["runs"];
    for (const char* name : {"benchmark.log", "progress.png", "config.yaml", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    }
    ASSERT_EQ(photonav(fmt::format("sweep {} {} --alpha 0.4 --out {}", config("two_textures"),
                                   kQuickBenchmark, folder_.string()))
                  .exitCode,
              0);
    const json theirs = parsed(folder_ / "result.json")["runs"];
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
        for (const char* key : {"planner", "seed", "alpha", "cost", "length", "mean_trace",
                                "goal_trace", "vertices", "views", "status"}) {
            EXPECT_EQ(ours[i][key], theirs[i][key]) << key;
        }
    }
}

TEST_F(BenchmarkCommand, NoPathIsExitCodeOneWithALog) {
    const Execution run = benchmark("--set planner.vertices=2 --runs 2 --planners rrt_star");
    EXPECT_EQ(run.exitCode, 1) << run.output;
    const json result = parsed(folder_ / "result.json");
    EXPECT_EQ(result["status"], "no path");
    EXPECT_EQ(result["runs"][0]["status"], "no path: the goal was not reached by 2 vertices");
    EXPECT_TRUE(fs::exists(folder_ / "benchmark.log"));
}

TEST_F(BenchmarkCommand, BadInputIsOneLineAndExitCodeTwo) {
    for (const auto& [arguments, reason] :
         {std::pair{"--planners rrt", "'rrt' is not one of"}, std::pair{"--runs 0", "sweep.runs"},
          std::pair{"--interval 0", "--interval"}, std::pair{"--seed x", "seed"}}) {
        const Execution run = benchmark(arguments);
        EXPECT_EQ(run.exitCode, 2) << arguments;
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    }
}

}  // namespace
}  // namespace photonav
