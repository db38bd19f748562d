// SPDX-License-Identifier: BSD-3-Clause
// What belief_rrt_star has found when it is stopped.
#include <gtest/gtest.h>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

std::shared_ptr<BeliefRRTstar> beliefPlanner(const Problem& problem) {
    return std::dynamic_pointer_cast<BeliefRRTstar>(problem.planner("belief_rrt_star"));
}

/// Stops by a condition that nothing is known of, as a clock would.
ob::PlannerStatus solveFor(BeliefPlanner& planner, std::size_t iterations) {
    return planner.solve(
        ob::PlannerTerminationCondition([&] { return planner.iterations() >= iterations; }));
}

TEST(Anytime, ACheckedPathIsAnAnswerBeforeTheFirstSearch) {
    Problem problem;
    problem.growth.goalBias = 0.5;
    const auto planner = beliefPlanner(problem);
    EXPECT_EQ(solveFor(*planner, 40), ob::PlannerStatus::EXACT_SOLUTION);
    EXPECT_LT(planner->vertices(), 100U);
    EXPECT_LT(planner->bestCost(), 100.);
    const auto path = planner->getProblemDefinition()->getSolutionPath();
    EXPECT_TRUE(path->check());
}

TEST(Anytime, ALongerBudgetIsNeverWorse) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        Problem problem;
        problem.growth.seed = seed;
        double last = kInfinity;
        for (std::size_t budget = 30; budget < 2000; budget = budget * 3 / 2) {
            const auto planner = beliefPlanner(problem);
            solveFor(*planner, budget);
            EXPECT_LE(planner->bestCost(), last) << budget << " samples";
            last = planner->bestCost();
        }
        EXPECT_LT(last, 10.);
    }
}

TEST(Anytime, DescendsWhileItGrows) {
    const auto planner = beliefPlanner(Problem{});
    const auto without = beliefPlanner(Problem{});
    without->params().setParam("shortcut", "0");
    solveFor(*planner, 1000);
    solveFor(*without, 1000);
    EXPECT_GT(planner->shortcutsTried(), 100U);
    EXPECT_LT(planner->bestCost(), without->bestCost());
}

TEST(Anytime, ResumingDoesNotRepeatAFinishedDescent) {
    const auto planner = beliefPlanner(Problem{});
    grow(*planner, 150);
    const unsigned tried = planner->shortcutsTried();
    EXPECT_GE(tried, 3000U);
    grow(*planner, 150);
    EXPECT_EQ(planner->shortcutsTried(), tried);
}

TEST(Anytime, ADescentThatWasCutShortIsMadeUpFor) {
    const auto planner = beliefPlanner(Problem{});
    planner->params().setParam("max_vertices", "150");
    planner->solve(ob::PlannerTerminationCondition(
        [&] { return planner->vertices() >= 150 && planner->shortcutsTried() > 0; }));
    const unsigned tried = planner->shortcutsTried();
    EXPECT_LT(tried, 3000U);
    planner->solve(ob::plannerNonTerminatingCondition());
    EXPECT_GE(planner->shortcutsTried(), 3000U);
    EXPECT_LT(planner->shortcutsTried(), 3000U + 300U);
}

TEST(Anytime, ASearchThatFindsTheSamePathContinuesItsDescent) {
    int same = 0;
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U, 5U}) {
        Problem problem;
        problem.growth.seed = seed;
        const auto planner = beliefPlanner(problem);
        grow(*planner, 150);
        const unsigned tried = planner->shortcutsTried();
        grow(*planner, 151);  // a single vertex more seldom makes another path the best
        same += planner->shortcutsTried() == tried ? 1 : 0;
    }
    EXPECT_GE(same, 3);
}

TEST(Anytime, SolvesForATime) {
    Problem problem;
    problem.growth.maxVertices = 500;
    const auto planner = beliefPlanner(problem);
    EXPECT_EQ(planner->solve(60.), ob::PlannerStatus::EXACT_SOLUTION);  // ends by its vertices
    const auto same = beliefPlanner(problem);
    grow(*same, 500);
    EXPECT_DOUBLE_EQ(planner->bestCost(), same->bestCost());
    EXPECT_EQ(planner->solve(0.), ob::PlannerStatus::EXACT_SOLUTION);  // keeps what it has
    EXPECT_DOUBLE_EQ(planner->bestCost(), same->bestCost());
}

}  // namespace
}  // namespace photonav::test
