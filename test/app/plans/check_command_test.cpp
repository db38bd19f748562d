// SPDX-License-Identifier: BSD-3-Clause
#include "plans/check_command.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "app/executable.hpp"
#include "map/octree_file.hpp"
#include "result/text_table.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Trajectories over the paper's first floor: white left of x = 4.95 m, nothing beyond x = 12 m.
class CheckCommand : public testing::Test {
  protected:
    Execution check(const std::string& arguments) const {
        return photonav(fmt::format("check {} --out {}", arguments, folder_.file("out")));
    }
    json result() const { return json::parse(test::contentOf(folder_.path() / "out/result.json")); }
    std::string scene() const {
        return fmt::format("--scene {}/config/scenes/two_textures.yaml", PHOTONAV_SOURCE_DIR);
    }
    void expectRefused(const Execution& run, const std::string& reason) const {
        EXPECT_EQ(run.exitCode, 2) << run.output;
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_FALSE(fs::exists(folder_.path() / "out"));
    }

    test::TemporaryFolder folder_;
};

TEST_F(CheckCommand, ATrajectoryOverTextureKeepsTheCameraLocalised) {
    const std::string file = folder_.write("way.csv", "t,x,y,z\n0,6,0,2\n4,6,4,2\n");
    const Execution run = check(file + " --headings 4 --config " + config("two_textures"));
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("the camera stays localised"), std::string::npos) << run.output;
    for (const char* name : {"result.json", "config.yaml", "path.tum", "top_view.png", "sigma.png",
                             "headings.png", "trace.png", "report.json", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_.path() / "out" / name)) << name;
    }
    const json r = result();
    EXPECT_EQ(r["is_lost"], false);
    EXPECT_EQ(r["status"], "done");
    EXPECT_EQ(r["path"].size(), 17U);
    EXPECT_NEAR(r["path"][8]["time_s"].get<double>(), 2., 1e-9);
    EXPECT_NEAR(r["length"].get<double>(), 4., 1e-9);
    EXPECT_LT(r["worst"]["position_sigma_m"].get<double>(), 0.1);
    EXPECT_TRUE(r["collisions"].empty());
    EXPECT_TRUE(r["flights"].is_null());
    std::ifstream page(folder_.file("out/report.json"));
    const json shown = json::parse(page);
    EXPECT_EQ(shown["title"], "Check of way.csv");
    EXPECT_EQ(shown["paths"][0]["mean_trace"], r["mean_trace"]);
    EXPECT_EQ(shown["paths"][1]["mean_trace"], r["with_best_headings"]["mean_trace"]);
}

/// The trajectory that was written is the one that was read.
TEST_F(CheckCommand, ReadsTheTrajectoryThatItWrites) {
    const std::string file = folder_.write("way.csv", "t,x,y,z\n0,6,0,2\n4,6,4,2\n");
    const std::string rest = " --headings 0 --config " + config("two_textures");
    ASSERT_EQ(check(file + rest).exitCode, 0);
    const double before = result()["mean_trace"];
    fs::rename(folder_.path() / "out", folder_.path() / "first");
    ASSERT_EQ(check(folder_.file("first/path.tum") + rest).exitCode, 0);
    EXPECT_NEAR(result()["mean_trace"].get<double>(), before, 1e-4 * before);
    EXPECT_EQ(result()["trajectory"]["format"], "tum");
    ASSERT_EQ(check(folder_.file("first/path.kitti") + rest).exitCode, 0);
    EXPECT_EQ(result()["trajectory"]["format"], "kitti");
}

TEST_F(CheckCommand, WithoutAConfigTheWorldIsThatAroundTheTrajectory) {
    const std::string file = folder_.write("way.txt", "6 0 2\n6 4 2\n");
    const Execution run = check(file + " --headings 0 --json " + scene());
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_EQ(json::parse(run.output), result());
    EXPECT_TRUE(result()["out_of_bounds"].empty());
}

TEST_F(CheckCommand, ALostCameraIsExitCodeOneWithItsReport) {
    const std::string file = folder_.write("way.txt", "8 4 2\n16 4 2\n");
    const Execution run = check(file + " --headings 0 --quiet " + scene());
    EXPECT_EQ(run.exitCode, 1) << run.output;
    EXPECT_EQ(run.output, "");
    const json r = result();
    ASSERT_EQ(r["lost"].size(), 1U);
    EXPECT_EQ(r["lost"][0]["cause"], "images rejected");
    EXPECT_EQ(r["lost"][0]["end"], r["length"]);
    EXPECT_EQ(r["path"].back()["image"], "rejected");
    EXPECT_EQ(r["path"].back()["lost"], "images rejected");
}

TEST_F(CheckCommand, CollisionsAndBoundsAreReportedNotRefused) {
    const std::string file = folder_.write("way.txt", "6 4 2\n6 12 2\n6 12 -1\n");
    const Execution run = check(file + " --headings 0 --config " + config("two_textures"));
    EXPECT_NE(run.exitCode, 2) << run.output;
    EXPECT_NEAR(result()["out_of_bounds"][0][0].get<double>(), 5.5, 0.03);
    const std::string low = folder_.write("low.txt", "6 4 2\n6 4 0.1\n6 6 0.1\n");
    check(low + " --headings 0 " + scene());
    EXPECT_NEAR(result()["collisions"][0][0].get<double>(), 1.8, 0.12);
}

/// A map whose only known cells are around the trajectory's second half.
std::string halfKnownMap(const test::TemporaryFolder& folder) {
    TexturedOcTree map(0.1);
    for (double x = 1.05; x < 4.; x += 0.1) {
        for (double y = -1.; y < 1.; y += 0.1) {
            for (double z = 0.15; z < 2.; z += 0.1) map.updateNode(x, y, z, false);
            map.updateNode(x, y, 0.05, true)->faces[5].observe(x < 2. ? 0.2F : 0.8F, 1.F);
        }
    }
    saveTexturedOcTree(map, folder.file("half.ot"));
    saveBinaryOcTree(map, folder.file("half.bt"));
    return folder.file("half.ot");
}

TEST_F(CheckCommand, UnknownCellsAreNotCollisions) {
    const std::string map = halfKnownMap(folder_);
    const std::string way = folder_.write("way.txt", "0 0 1\n3 0 1\n");
    const Execution run = check(way + " --headings 0 --map " + map);
    EXPECT_NE(run.output.find("in collision                       none"), std::string::npos)
        << run.output;
    EXPECT_NE(run.output.find("next to unknown cells              0.00 to 1."), std::string::npos)
        << run.output;
    EXPECT_EQ(result()["unknown_cells"].size(), 1U);
    EXPECT_TRUE(result()["collisions"].empty());
}

TEST_F(CheckCommand, AMapWithoutGreyValuesIsRefused) {
    halfKnownMap(folder_);
    const std::string way = folder_.write("way.txt", "0 0 1\n3 0 1\n");
    expectRefused(check(way + " --map " + folder_.file("half.bt")), "half.bt: no cell of the map");
}

TEST_F(CheckCommand, LinesFitIntoEightyColumns) {
    const std::string file = folder_.write("way.txt", "8 4 2\n16 4 2\n");
    const Execution run = check(file + " --headings 2 --flights 1 " + scene());
    std::istringstream lines(run.output);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_TRUE(characters(line) <= 80U || line.starts_with("report: ")) << line;
    }
    EXPECT_NE(run.output.find("1 arrived, 0 collided"), std::string::npos) << run.output;
}

TEST_F(CheckCommand, FlightsAlongTheTrajectoryFollowFromTheSeed) {
    const std::string file = folder_.write("way.txt", "6 1 2\n6 4 2\n");
    const std::string arguments =
        file + " --headings 0 --flights 2 --config " + config("two_textures");
    ASSERT_EQ(check(arguments + " --seed 3").exitCode, 0);
    const json first = result()["flights"];
    EXPECT_EQ(first["flights"], 2);
    EXPECT_EQ(first["arrived"], 2);
    check(arguments + " --set seed=3");
    EXPECT_EQ(result()["flights"], first);
    check(arguments + " --seed 4");
    EXPECT_NE(result()["flights"]["position_rmse_m"], first["position_rmse_m"]);
}

TEST_F(CheckCommand, BadInputIsOneLineAndWritesNothing) {
    const std::string way = folder_.write("way.txt", "6 0 2\n6 4 2\n");
    expectRefused(check(way), "way.txt: needs a world: give --map, --scene or --config");
    expectRefused(check(folder_.file("none.csv") + " " + scene()), "none.csv: no such file");
    expectRefused(check(folder_.write("nan.txt", "0 0 2\nnan 0 2\n") + " " + scene()),
                  "nan.txt: line 2: 'nan' is not a finite number");
    expectRefused(check(way + " --heading left " + scene()), "--heading: left: expected forward");
    expectRefused(check(way + " --map " + way), "not an OctoMap");
    expectRefused(check(way + " --map a.ot --scene b.yaml"), "--map");
    expectRefused(check(way + " --map nope.ot"), "photonav: --map: nope.ot: no such file");
    expectRefused(check(way + " --scene nope.yaml"), "photonav: --scene: nope.yaml: no such file");
    expectRefused(check(way + " --headings -1 " + scene()), "--headings");
    const std::string tilted = folder_.write(
        "tilted.tum", "0 6 1 2 0 0 0 1\n1 6 4 2 0 0 0 1\n");  // the mount is down, the camera up
    expectRefused(check(tilted + " --flights 1 " + scene()), "tilted by up to 180 degrees");
}

}  // namespace
}  // namespace photonav
