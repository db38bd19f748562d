// SPDX-License-Identifier: BSD-3-Clause
// photonav info, as a user runs it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/command_test.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class InfoCommand : public CommandTest {};

TEST_F(InfoCommand, LooksAlongTheHeadingOfTheConfig) {
    const std::string command = "info " + config("two_textures") + " --cells 2 --out " +
                                folder_.string() + " --set start=[0,0,2,1.2] --at 5.5,4,2";
    ASSERT_EQ(photonav(command + " --set space=xyz").exitCode, 0);
    EXPECT_EQ(result()["view"]["yaw"], 1.2);
    ASSERT_EQ(photonav(command + ",0.3").exitCode, 0);
    EXPECT_EQ(result()["view"]["yaw"], 0.3);
}

TEST_F(InfoCommand, DrawsHeatMapsAndContributions) {
    const Execution run = photonav("info " + config("two_textures") +
                                   " --cells 12 --at 5.5,4,2 --out " + folder_.string());
    ASSERT_EQ(run.exitCode, 0) << run.output;
    for (const char* name : {"result.json", "config.yaml", "information.png", "uncertainty.png",
                             "view.png", "contribution.png", "contribution_right.png",
                             "contribution_about_forward.png", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    }
    const json r = result();
    EXPECT_GT(r["view"]["min_eigenvalue"].get<double>(), 0.);
    const auto& rows = r["grid"]["rows_from_smallest_y"];
    EXPECT_EQ(rows.front().front().get<double>(), 0.);  // white floor on the left
    EXPECT_GT(rows.front().back().get<double>(), 1e3);  // texture on the right
    EXPECT_EQ(rows.size(), 12U);
}

/// A view of this size takes seconds.
TEST_F(InfoCommand, EndsAtOnceAndSaysSo) {
    const Execution run = interrupt(
        fmt::format("{} info {} --set camera.width=8192 --set camera.height=8192 --out {}",
                    PHOTONAV_BINARY, config("two_textures"), folder_.string()),
        kCatchesSignals, 0.3, "TERM");
    EXPECT_EQ(run.exitCode, 143);
    EXPECT_EQ(run.output, "photonav: interrupted before there was any result\n");
    EXPECT_FALSE(fs::exists(folder_));
    EXPECT_FALSE(fs::exists(folder_.string() + ".unfinished"));
}

}  // namespace
}  // namespace photonav
