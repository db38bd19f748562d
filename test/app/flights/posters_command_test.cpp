// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/executable.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Candidates for the paper's first floor, which is white at the goal.
class PostersCommand : public testing::Test {
  protected:
    Execution posters(const std::string& arguments) const {
        return photonav(fmt::format("posters {} --trials 2 --duration 10 {} --out {}",
                                    config("two_textures"), arguments, folder_.file("out")));
    }
    std::string shipped() const {
        return fmt::format("--candidates {}", config("posters/two_textures"));
    }
    json result() const { return json::parse(test::contentOf(folder_.path() / "out/result.json")); }

    test::TemporaryFolder folder_;
};

TEST_F(PostersCommand, RanksTheShippedCandidatesByAPlannedPath) {
    const Execution run =
        posters(shipped() + " --set planner.vertices=300 --distances 0.1 --jobs 2");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    for (const char* name : {"result.json", "config.yaml", "sigma.png", "maps.png", "goals.png",
                             "report.json", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_.path() / "out" / name)) << name;
    }
    std::istringstream lines(run.output);
    for (std::string line; std::getline(lines, line) && !line.starts_with("report");) {
        EXPECT_LE(line.size(), 80U) << line;
    }
    const json r = result();
    EXPECT_EQ(r["path_is"], "planned");
    ASSERT_EQ(r["ranking"].size(), 6U);
    EXPECT_EQ(r["ranking"][0]["name"], "halfway carpet");
    EXPECT_LT(r["ranking"][0]["cost"], r["ranking"][5]["cost"]);
    EXPECT_TRUE(r["verdict"].get<std::string>().starts_with(
        "'halfway carpet' is the best for the path: mean trace along the path "));
}

TEST_F(PostersCommand, RanksByServoingAtTheGoalAlone) {
    const Execution run = posters(shipped() + " --goal-only");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_FALSE(fs::exists(folder_.path() / "out/sigma.png"));
    const json r = result();
    EXPECT_EQ(r["ranked_by"], "goal");
    EXPECT_EQ(r["path_is"], nullptr);
    EXPECT_EQ(r["ranking"][0]["name"], "goal carpet");
    EXPECT_EQ(r["ranking"][1]["name"], "striped runner");  // more certain, but converges less often
    EXPECT_LT(r["ranking"][1]["servo"]["position_sigma_m"],
              r["ranking"][0]["servo"]["position_sigma_m"]);
    EXPECT_EQ(r["ranking"][2]["name"], "none");
}

TEST_F(PostersCommand, SaysWhenNothingHelps) {
    const std::string file =
        folder_.write("white.yaml",
                      "candidates: [{name: white, textures: [{name: t, grey: 0.9}], "
                      "planes: [{corner: [1, 8, 0.1], u: [2, 0, 0], v: [0, 2, 0], texture: t}]}]");
    const std::string way = folder_.write("way.csv", "x,y,z,yaw\n0,0,2,1.57\n2,9,2,1.57\n");
    const Execution run = posters("--rank-by goal --trajectory " + way + " --candidates " + file);
    EXPECT_EQ(run.exitCode, 1) << run.output;  // directions stay open
    EXPECT_EQ(result()["path_is"], "given");
    EXPECT_EQ(result()["verdict"], "no candidate improves on the scene as it is");
    EXPECT_TRUE(result()["ranking"][0]["cost"].is_null());
}

TEST_F(PostersCommand, RefusesBadInput) {
    const auto expectRefused = [&](const std::string& arguments, const std::string& reason) {
        const Execution run = posters(arguments);
        EXPECT_EQ(run.exitCode, 2) << run.output;
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_FALSE(fs::exists(folder_.path() / "out"));
    };
    expectRefused(shipped() + " --rank-by path --goal-only", "--rank-by excludes --goal-only");
    expectRefused("--candidates none.yaml", "none.yaml: no such file");
    expectRefused(shipped() + " --trajectory none.tum", "none.tum: no such file");
    expectRefused(shipped() + " --rank-by luck", "--rank-by: luck not in {path,goal}");
    const std::string box =
        folder_.write("box.yaml",
                      "candidates: [{name: box, textures: [{name: t}], "
                      "boxes: [{min: [1, 8, 0], max: [3, 9.4, 2.5], texture: t}]}]");
    expectRefused("--candidates " + box,
                  "box.yaml: candidates[0]: 'box' puts the goal in collision");
    expectRefused("--candidates " + box + " --goal-only",
                  "box.yaml: candidates[0]: 'box' puts the goal in collision");
}

}  // namespace
}  // namespace photonav
