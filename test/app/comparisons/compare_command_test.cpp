// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/executable.hpp"
#include "comparisons/compare_command.hpp"
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
        EXPECT_NE(table.str().find("| " + method.label() + " |"), std::string::npos);
    }
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
    const std::string table =
        compareTable({{method, 1, found, "done"}, {method, 2, PlanOutcome{}, "no path"}});
    EXPECT_NE(table.find("| " + method + " (1 of 2 found a path) | 2.000 |"), std::string::npos)
        << table;
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
