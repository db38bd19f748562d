// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/executable.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using nlohmann::json;

TEST(ServoCommand, WritesBasinAndModesOfTheGoal) {
    const test::TemporaryFolder folder;
    const Execution run =
        photonav("servo " + config("two_textures") +
                 " --at 5,5,2 --trials 2 --distances 0.05,30 --angles 0 --duration 5 --out " +
                 folder.file("out"));
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("slowest direction"), std::string::npos) << run.output;
    for (const char* name : {"basin.png", "modes.png", "goal.png", "report.html", "config.yaml"}) {
        EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / name)) << name;
    }
    std::ifstream in(folder.file("out/result.json"));
    const json result = json::parse(in);
    ASSERT_EQ(result["basin"].size(), 2U);
    EXPECT_EQ(result["basin"][0]["converged"], 2);
    EXPECT_EQ(result["basin"][1]["converged"], 0);
    EXPECT_EQ(result["basin"][1]["median_s"], nullptr);
    ASSERT_EQ(result["modes"].size(), 4U);
    EXPECT_GT(result["modes"][0]["rate_per_s"], 0.);
}

TEST(ServoCommand, AGoalWithoutTextureIsSaidOnceAndHasNoModesToDraw) {
    const test::TemporaryFolder folder;
    const Execution run =
        photonav("servo " + config("two_textures") +
                 " --at 1,5,2 --trials 1 --distances 0.05,0.1 --angles 0 --duration 1 --out " +
                 folder.file("out"));
    EXPECT_EQ(run.exitCode, 1) << run.output;
    EXPECT_NE(run.output.find("none of 2 starts converges"), std::string::npos) << run.output;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/basin.png"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/modes.png"));
}

TEST(ServoCommand, RefusesWhatIsNoStudy) {
    const std::string servo = "servo " + config("two_textures") + " ";
    const auto expectReason = [&](const std::string& options, const std::string& reason) {
        const Execution run = photonav(servo + options);
        EXPECT_EQ(run.exitCode, 2);
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
    };
    expectReason("--distances 0.1,-1", "--distances: 0.1,-1: expected numbers from 0 to 1000");
    expectReason("--angles much", "--angles: much: expected numbers from 0 to 180");
    expectReason("--gain 20", "--gain: above --rate");
    expectReason("--at 99,0,2", "--at: 99,0,2: outside the bounds");
}

}  // namespace
}  // namespace photonav
