// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/executable.hpp"
#include "comparisons/compare_command.hpp"
#include "plot/color.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

TEST(Compare, EveryMethodOnceJudgedByTheSameBeliefs) {
    const fs::path folder = fs::temp_directory_path() / "photonav_compare";
    fs::remove_all(folder);
    const Execution run =
        photonav("compare " + config("two_textures") + " --runs 1 --out " + folder.string() +
                 " --set planner.vertices=150 --set planner.view_pitch=0.5 --set seed=7 --quiet");
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const auto result = nlohmann::json::parse(std::ifstream(folder / "result.json"));
    const auto& runs = result["scenarios"][0]["runs"];
    ASSERT_EQ(runs.size(), compareMethods().size());
    std::map<std::string, nlohmann::json> byMethod;
    for (const auto& r : runs) {
        byMethod[r["method"]] = r;
        EXPECT_EQ(r["seed"], 7);
    }
    // A planner whose information model is that of the evaluation gets its own cost; one without
    // views does not.
    const auto& ours = byMethod["belief_rrt_star, photometric"];
    EXPECT_NEAR(ours["cost"], ours["planner_cost"], 1e-9);
    const auto& blind = byMethod["belief_rrt_star, none"];
    EXPECT_EQ(blind["views"], 0);
    EXPECT_GT(blind["planner_cost"], 0.);
    EXPECT_GT(blind["cost"], 1.2 * ours["cost"].get<double>());
    EXPECT_LT(blind["length"], ours["length"]);
    EXPECT_TRUE(fs::exists(folder / "two_textures.png"));
    std::stringstream table;
    table << std::ifstream(folder / "two_textures.md").rdbuf();
    for (const CompareMethod& method : compareMethods()) {
        EXPECT_NE(table.str().find("| " + method.label() + " "), std::string::npos);
    }
    const std::string page = test::contentOf((folder / "report.json").string());
    const auto report = nlohmann::json::parse(page);
    EXPECT_EQ(report["paths"].size(), compareMethods().size());
    std::set<std::string> colours{hexColor(plannerColor("rrt_star/fixed")),
                                  hexColor(plannerColor("rrt_star/forward"))};
    for (const auto& path : report["paths"]) {
        EXPECT_TRUE(colours.insert(path["color"]).second) << path["name"];
        EXPECT_EQ(path["mean_trace"], byMethod[path["name"]]["mean_trace"]);
    }
    EXPECT_EQ(report["text_tables"][0]["rows"].size(), compareMethods().size());
    EXPECT_EQ(report["figures"].size(), 1U);
    EXPECT_TRUE(fs::exists(folder / "report.html") && fs::exists(folder / "config.yaml"));
    fs::remove_all(folder);
}

TEST(Compare, ItsFilesAndItsInputsStayApart) {
    const test::TemporaryFolder folder;
    const auto text = test::contentOf(config("two_textures"));
    fs::create_directories(folder.path() / "scenes");
    fs::copy(fs::path(config("two_textures")).parent_path() / "scenes" / "two_textures.yaml",
             folder.path() / "scenes");
    const std::string named = folder.write("line\nbreak.yaml", text);
    const std::string command = "compare '" + named +
                                "' --runs 1 --set planner.vertices=50 --set planner.view_pitch=1 "
                                "--set camera.width=94 --set camera.height=60 --quiet --out ";
    expectBadInput(photonav(command + folder.file("scenes")), "which this run reads");
    for (int i = 0; i < 2; ++i) {  // and once more in the place of the first
        const Execution run = photonav(command + folder.file("out"));
        EXPECT_LE(run.exitCode, 1) << run.output;
        EXPECT_TRUE(fs::exists(folder.path() / "out" / "line_break.md"));
    }
}

TEST(Compare, ItsTableSaysHowManyRunsFoundAPath) {
    const std::string method = compareMethods().front().label();
    PlanOutcome found;
    found.path = EvaluatedPath{};
    found.path->cost = 2.;
    const std::vector<CompareRun> runs{{method, 1, found, "done"},
                                       {method, 2, PlanOutcome{}, "no path"}};
    for (const TextTable& table : {comparisonTable(runs), shortComparisonTable(runs)}) {
        ASSERT_EQ(table.rows.size(), 1U);
        EXPECT_EQ(table.rows[0].size(), table.head.size());
        EXPECT_EQ(table.rows[0][0], method + " (1 of 2 found a path)");
        EXPECT_EQ(table.rows[0][1], "2.000");
    }
}

/// Whatever the methods are called, and traces have three digits.
TEST(Compare, ItsShortTableFitsIntoATerminal) {
    std::vector<CompareRun> runs;
    for (const CompareMethod& method : compareMethods()) {
        CompareRun& run = runs.emplace_back(CompareRun{method.label(), 1, {}, "done"});
        run.outcome.path = EvaluatedPath{};
        run.outcome.path->cost = 123.4567;
        run.outcome.path->length = 123.4567;
        run.outcome.path->meanTrace = run.outcome.path->goalTrace = 1.2345e-5;
    }
    const std::string text = alignedText(shortComparisonTable(runs));
    EXPECT_EQ(text.find("\n\n"), std::string::npos) << "wider than 80 characters:\n" << text;
}

TEST(Compare, SeveralConfigsShareAPage) {
    const test::TemporaryFolder folder;
    const std::string out = folder.file("out");
    const Execution run = photonav(
        "compare " + config("two_textures") + " " + config("stripes") + " --runs 1 --out " + out +
        " --json --set planner.vertices=60 --set planner.view_pitch=1 --set camera.width=94 "
        "--set camera.height=60");
    EXPECT_LE(run.exitCode, 1) << run.output;
    EXPECT_EQ(nlohmann::json::parse(run.output)["scenarios"].size(), 2U);
    const auto report = nlohmann::json::parse(test::contentOf(out + "/report.json"));
    EXPECT_EQ(report["title"], "two_textures, stripes");
    EXPECT_EQ(report["text_tables"].size(), 2U);
    EXPECT_EQ(report["figures"].size(), 2U);
    EXPECT_FALSE(fs::exists(out + "/config.yaml"));
}

TEST(Compare, TwoConfigsOfOneNameAreRefused) {
    const fs::path folder = fs::temp_directory_path() / "photonav_compare_names";
    const std::string file = config("two_textures");
    const Execution run = photonav("compare " + file + " " + file + " --out " + folder.string());
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_NE(run.output.find("has the name of"), std::string::npos) << run.output;
    EXPECT_FALSE(fs::exists(folder));
}

TEST(Compare, AMissingConfigIsOneLine) {
    const Execution run = photonav("compare no_such.yaml");
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_NE(run.output.find("no_such.yaml"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace photonav
