// SPDX-License-Identifier: BSD-3-Clause
// The table of a sweep in words, and what its figures show.
#include "comparisons/sweep_report.hpp"

#include <gtest/gtest.h>

#include "figures/sweep_figures.hpp"
#include "sweep_run.hpp"

namespace photonav {
namespace {

using test::makeRun;

TEST(SweepTables, PutThePaperBesideOurs) {
    auto [config, runs] = test::SampleSweep();
    const auto cells = summarize(config, runs, {});
    const std::string table = sweepTable(cells);
    EXPECT_NE(table.find("40.45"), std::string::npos) << table;
    EXPECT_EQ(table.find("paper", table.find("\nrrt_star")), std::string::npos) << table;
    EXPECT_NE(table.find("(traces in m²)"), std::string::npos) << table;
    // As many decimals as the smallest trace, 1.5e-5, can be read with.
    config.paper.clear();
    const std::string small =
        sweepTable(summarize(config, {makeRun({"pa_rrt_star", 0.15, 1}, 3., 10., 3e-5)}, {}));
    EXPECT_NE(small.find(" 0.000015"), std::string::npos) << small;
}

TEST(SweepFigures, TheFrontHoldsWhatNothingBeats) {
    const auto cell = [](const std::string& planner, double alpha, double length, double trace) {
        SweepCell c;
        c.planner = planner;
        c.alpha = alpha;
        c.solved = 1;
        c.columns = {{"length", {length, 0.}}, {"mean_trace", {trace, 0.}}};
        return c;
    };
    const std::vector<SweepCell> cells{
        cell("pa_rrt_star", .1, 12., .1), cell("pa_rrt_star", .5, 11., .2),
        cell("pa_rrt_star", .7, 11.5, .3), cell("belief_rrt_star", .5, 1., .01),
        cell("pa_rrt_star", .9, 9., .4)};
    EXPECT_EQ(paretoFront("pa_rrt_star", cells), (std::vector<std::size_t>{4, 1, 0}));
}

TEST(SweepFigures, TheCheapestPathOfEveryAlphaIsDrawn) {
    const std::vector<SweepRun> runs{makeRun({"pa_rrt_star", 0.5, 1}, 2., 9., 0.1),
                                     makeRun({"pa_rrt_star", 0.5, 2}, 1., 9., 0.1),
                                     makeRun({"belief_rrt_star", 0.5, 1}, 0.5, 9., 0.1),
                                     makeRun({"pa_rrt_star", 0.1, 1}, 2., 9., 0.1)};
    const auto best = cheapestRuns("pa_rrt_star", runs);
    ASSERT_EQ(best.size(), 2U);
    EXPECT_EQ(best.at(0.1), &runs[3]);
    EXPECT_EQ(best.at(0.5), &runs[1]);
}

}  // namespace
}  // namespace photonav
