// SPDX-License-Identifier: BSD-3-Clause
// Commands of many runs: how long they still take, and where their results are.
#include "shared/many_runs.hpp"

#include <gtest/gtest.h>

#include "sweep/sweep_plan.hpp"

namespace photonav {
namespace {

TEST(RemainingTime, IsThatOfThePlannersRunsOnTheClock) {
    const std::vector<SweepItem> open{{"slow"}, {"slow"}, {"slow"}, {"fast"}, {"fast"}, {"new"}};
    RemainingTime rest(open);
    EXPECT_EQ(rest.text(7.), "");
    rest.count("slow", 100., 50.);  // on two threads: half the time on the clock
    // Of others, as much as of those that are known: 5 runs of 100 s.
    EXPECT_NEAR(rest.seconds(50.), 250., 1e-9);
    rest.count("fast", 20., 60.);
    // 2 slow ones, 1 fast one, and one of 60 s: 280 s at half of that on the clock.
    EXPECT_NEAR(rest.seconds(60.), 140., 1e-9);
    EXPECT_NEAR(rest.seconds(100.), 100., 1e-9);  // while no run ends
    EXPECT_EQ(rest.seconds(1000.), 0.);
    EXPECT_EQ(rest.text(60.), ", about 2 min left");
    EXPECT_EQ(rest.text(100.), ", about 100 s left");
    EXPECT_EQ(durationText(7200.), "2.0 h");
}

TEST(ManyRunsFolder, IsNamedByTheConfigAndTheShard) {
    constexpr RunWords kWords{"sweep", "runs.jsonl", "run", "a sweep", "the sweep"};
    ManyRunsOptions options;
    EXPECT_EQ(folderOf(options, kWords, "room", {}), "out/sweep-room");
    EXPECT_EQ(folderOf(options, kWords, "room", {2, 3}), "out/sweep-room-2of3");
    options.out = "here";
    EXPECT_EQ(folderOf(options, kWords, "room", {2, 3}), "here");
}

}  // namespace
}  // namespace photonav
