// SPDX-License-Identifier: BSD-3-Clause
#include "planners/replan_from_scratch.hpp"

#include <gtest/gtest.h>
#include <ompl/geometric/PathGeometric.h>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

/// Ends a test that would hang.
ob::PlannerTerminationCondition never() {
    return ob::PlannerTerminationCondition([] { return false; });
}

double lengthOf(const BeliefPlanner& planner) {
    return planner.getProblemDefinition()->getSolutionPath()->length();
}

TEST(ReplanFromScratch, FollowsTheMapAndTheStart) {
    Problem problem;
    problem.information = {};  // the shortest way is the best
    problem.growth.maxVertices = 400;
    ReplanFromScratch replanner([&] { return problem.planner("belief_rrt_star"); });
    EXPECT_EQ(replanner.planner(), nullptr);
    ASSERT_TRUE(static_cast<bool>(replanner.replan(never())));
    EXPECT_LT(lengthOf(*replanner.planner()), 8.3);  // 8 m straight on

    // A wall with a gap at x > 8 comes into sight.
    problem.clearance = [](const Eigen::Vector3d& p) {
        return p.x() > 8. ? 1. : std::abs(p.y() - 5.);
    };
    ASSERT_TRUE(static_cast<bool>(replanner.replan(never())));
    EXPECT_GT(lengthOf(*replanner.planner()), 12.8);

    problem.start = {9., 5., 2.};  // in the gap
    ASSERT_TRUE(static_cast<bool>(replanner.replan(never())));
    EXPECT_LT(lengthOf(*replanner.planner()), 7.8);
    EXPECT_EQ(replanner.effort().plans, 3U);
    EXPECT_EQ(replanner.effort().vertices, 1200U);
}

TEST(ReplanFromScratch, LooksAgainWhereItHasLookedBefore) {
    Problem problem;
    problem.growth.maxVertices = 300;
    ReplanFromScratch replanner([&] { return problem.planner("belief_rrt_star"); });
    replanner.replan(never());
    const ReplanEffort once = replanner.effort();
    const double cost = replanner.planner()->bestCost();
    replanner.replan(never());
    EXPECT_GT(once.views, 100U);
    EXPECT_EQ(replanner.effort().views, 2 * once.views);
    EXPECT_GT(replanner.effort().seconds, once.seconds);
    EXPECT_DOUBLE_EQ(replanner.planner()->bestCost(), cost);  // the same problem, the same answer
}

}  // namespace
}  // namespace photonav::test
