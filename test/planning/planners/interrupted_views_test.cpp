// SPDX-License-Identifier: BSD-3-Clause
// Planners whose views are stopped while they are rendered.
#include <gtest/gtest.h>

#include "planning/fixture.hpp"
#include "render/interruptible_views.hpp"

namespace photonav::test {
namespace {

class InterruptedViews : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Planners, InterruptedViews,
                         testing::Values("pa_rrt_star", "rrbt", "belief_rrt_star"),
                         [](const auto& test) { return test.param; });

/// OMPL's benchmark does not expect exceptions.
TEST_P(InterruptedViews, EndASearchThatKnowsOfTheInterruption) {
    bool isInterrupted = false;
    int views = 0;
    Problem problem;
    problem.information = [&](const Pose& T_c_w) {
        isInterrupted = ++views > 3;
        if (isInterrupted) throw RenderingStopped();
        return stripesThenTexture(T_c_w);
    };
    const auto planner = problem.planner(GetParam());
    planner->endWhen([&] { return isInterrupted; });
    EXPECT_EQ(grow(*planner, 150), ob::PlannerStatus::TIMEOUT);
}

/// At whatever view: a planner that has a path reports it, and can be used, cleared and destroyed.
TEST_P(InterruptedViews, LeaveThePathThatWasFoundBefore) {
    int stops = 0, paths = 0;
    for (int last = 0;; last += 1 + last / 3) {
        int views = 0;
        Problem problem;
        problem.information = [&](const Pose& T_c_w) {
            if (views++ == last) throw RenderingStopped();
            return stripesThenTexture(T_c_w);
        };
        const auto planner = problem.planner(GetParam());
        try {
            const bool isSolved = grow(*planner, 150) == ob::PlannerStatus::EXACT_SOLUTION;
            if (views <= last) break;
            EXPECT_TRUE(isSolved) << last;
            EXPECT_TRUE(std::isfinite(planner->bestCost())) << last;
            ++paths;
            static_cast<void>(planner->tree());
        } catch (const RenderingStopped&) {
            EXPECT_FALSE(std::isfinite(planner->bestCost())) << last;
            ++stops;
        }
        planner->clear();
        EXPECT_EQ(grow(*planner, 150), ob::PlannerStatus::EXACT_SOLUTION) << last;
    }
    EXPECT_GT(stops, 3);
    EXPECT_GT(paths, 0);
}

}  // namespace
}  // namespace photonav::test
