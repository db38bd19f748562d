// SPDX-License-Identifier: BSD-3-Clause
// The progress of commands on standard error.
#include "shared/command_io.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/command_test.hpp"
#include "app/explorations/quick_exploration.hpp"

namespace photonav {
namespace {

using Seconds = std::chrono::duration<double>;

/// What is printed by texts that are shown at some times [s], without a terminal.
std::string printed(bool quiet, double period, const std::vector<double>& times) {
    testing::internal::CaptureStderr();
    {
        ProgressLine line(quiet, period);
        double now = 0.;
        for (const double time : times) {
            std::this_thread::sleep_for(Seconds(time - now));
            line.show(fmt::format("at {}", now = time));
        }
    }
    return testing::internal::GetCapturedStderr();
}

TEST(ProgressLine, IsALinePerPeriodWithoutATerminal) {
    EXPECT_EQ(printed(false, 0.2, {0., 0.25, 0.3, 0.5}), "photonav: at 0.25\nphotonav: at 0.5\n");
    EXPECT_EQ(printed(false, 30., {0., 0.02}), "");
    EXPECT_EQ(printed(true, 0., {0., 0.02}), "");
}

TEST(ProgressLine, SaysWhatStaysAtOnce) {
    for (const bool quiet : {false, true}) {
        testing::internal::CaptureStderr();
        ProgressLine(quiet).say("this");
        EXPECT_EQ(testing::internal::GetCapturedStderr(), quiet ? "" : "photonav: this\n");
    }
}

TEST(ProgressLine, HasTheTimeLeftOfThePhase) {
    testing::internal::CaptureStderr();
    ProgressLine line(false, 0.);
    line.show("none", 0.);
    std::this_thread::sleep_for(Seconds(0.2));
    line.show("a part", 0.04);
    line.beginPhase();
    line.show("next", 0.5);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "photonav: none\nphotonav: a part, about 5 s left\nphotonav: next, about 0 s left\n");
}

/// script(1) makes a terminal.
std::string onTerminal(const std::string& arguments) {
    return execute(
               fmt::format("script -qec '{} {}' /dev/null < /dev/null", PHOTONAV_BINARY, arguments))
        .output;
}

using Progress = CommandTest;

TEST_F(Progress, ShowsTheTimeLeft) {
    const std::string out = " --out " + folder_.string();
    for (const std::string& command :
         {"info " + config("two_textures") + " --cells 8",
          "servo " + config("two_textures") + " --distances 0.1,0.2 --angles 0 --trials 1",
          std::string("replay " PHOTONAV_SOURCE_DIR "/data/flight_down --odometry --frames 0:8"),
          std::string("map " PHOTONAV_SOURCE_DIR "/data/flight_down --frames 0:4"),
          "compare " + config("two_textures") + kQuickPlan + "--runs 1",
          "fly " + config("two_textures") + kQuickPlan + "--flights 2"}) {
        const std::string output = onTerminal(command + out);
        EXPECT_NE(output.find(" left"), std::string::npos) << output;
    }
}

TEST_F(Progress, NamesWhatIsDone) {
    const std::string out = " --out " + folder_.string();
    const std::string planning = onTerminal("plan " + config("two_textures") + kQuickPlan +
                                            "--evolution --set planner.kappa=auto" + out);
    const std::string mapping =
        onTerminal("map " PHOTONAV_SOURCE_DIR "/data/flight_down --frames 0:4" + out);
    for (const char* text :
         {"kappa by rrt_star: ", "\rbelief_rrt_star: ", "rrt_star for comparison: ",
          "tree of rrt_star: ", "tree of belief_rrt_star: "}) {
        EXPECT_NE(planning.find(text), std::string::npos) << planning;
    }
    EXPECT_NE(mapping.find("0 of 1 compared"), std::string::npos) << mapping;
}

/// `plan` prints it with the shares of the cost.
TEST_F(Progress, EveryCommandSaysTheAutomaticKappa) {
    const std::string problem = " " + config("two_textures") + kQuickPlan +
                                "--set planner.kappa=auto --out " + folder_.string() + " ";
    for (const std::string& command :
         {"sweep" + problem + "--runs 1 --alpha 0.5 --planners rrt_star",
          "compare" + problem + "--runs 1", "benchmark" + problem + "--runs 1 --planners rrt_star",
          "fly" + problem + "--flights 1",
          "posters" + problem + "--trials 1 --candidates " + config("posters/two_textures"),
          "explore" + problem + kQuickExploration}) {
        const std::string output = photonav(command).output;
        EXPECT_NE(output.find("photonav: planner.kappa: auto is "), std::string::npos)
            << command << ": " << output;
    }
}

}  // namespace
}  // namespace photonav
