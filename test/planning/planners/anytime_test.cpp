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

/// A search that a condition has stopped is made up for at the next solve(), with its descent.
TEST(Anytime, GoesOnImprovingWhenItIsStoppedAgainAndAgain) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        Problem problem;
        problem.growth.seed = seed;
        const auto planner = beliefPlanner(problem);
        unsigned before = 0, descents = 0;
        for (std::size_t budget = 400; budget <= 2400; budget += 400) {
            solveFor(*planner, budget);
            descents += planner->shortcutsTried() > before ? 1 : 0;
            before = planner->shortcutsTried();
        }
        EXPECT_GE(descents, 4U) << seed;
    }
}

/// A planner whose time is counted: a view takes a millisecond, a look at the clock 10 us.
struct TimedPlanner {
    explicit TimedPlanner(std::uint32_t seed) {
        problem.growth.seed = seed;
        problem.information = [this](const Pose& T_c_w) {
            seconds += 1e-3;
            return stripesThenTexture(T_c_w);
        };
        planner = beliefPlanner(problem);
        planner->setClock([this] { return seconds += 1e-5; });
    }

    double seconds = 0.;
    Problem problem;
    std::shared_ptr<BeliefRRTstar> planner;
};

/// Except for what the last descents differ by: they begin at different paths.
TEST(Anytime, ALongerTimeIsNeverWorse) {
    constexpr double kDescents = 1.03;
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        double last = kInfinity;
        for (const double budget : {0.25, 0.5, 1., 2., 4., 8.}) {
            const TimedPlanner timed(seed);
            timed.planner->solve(budget);
            EXPECT_LE(timed.planner->bestCost(), kDescents * last) << budget << " s, seed " << seed;
            last = timed.planner->bestCost();
        }
        EXPECT_LT(last, 10.);
    }
}

/// Through OMPL's interface, which knows conditions only.
TEST(Anytime, ATimeLimitIsATimeKnownInAdvance) {
    const TimedPlanner timed(1), limited(1);
    timed.planner->solve(2.);
    ob::Planner& planner = *limited.planner;
    planner.params().setParam("time_limit", "2");
    planner.solve(ob::plannerNonTerminatingCondition());
    EXPECT_NEAR(limited.seconds, timed.seconds, 1e-9);
    EXPECT_EQ(limited.planner->bestCost(), timed.planner->bestCost());
    EXPECT_GT(limited.planner->shortcutsTried(), 0U);
}

/// Nothing is left to do for a solve() that adds no vertices.
TEST(Anytime, TheLastSearchAndItsDescentEndBeforeTheDeadline) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        for (const double budget : {4., 8.}) {
            TimedPlanner timed(seed);
            BeliefRRTstar& planner = *timed.planner;
            planner.solve(budget);
            EXPECT_LT(timed.seconds, budget + 0.01);
            const unsigned tried = planner.shortcutsTried();
            const double cost = planner.bestCost();
            planner.params().setParam("max_vertices", std::to_string(planner.vertices()));
            planner.solve(ob::plannerNonTerminatingCondition());
            EXPECT_EQ(planner.shortcutsTried(), tried) << budget;
            EXPECT_EQ(planner.bestCost(), cost) << budget;
        }
    }
}

/// Whatever it is doing, it ends the motion that it is working on, and no more. The next solve()
/// does what is left.
TEST(Anytime, EndsWithinAMotionOfTheCondition) {
    constexpr std::size_t kOneMotion = 40;  // views or checks
    std::size_t most = 1;
    for (std::size_t limit = 50; limit < most || most == 1; limit += 1 + limit / 20) {
        std::size_t work = 0;
        Problem problem;
        problem.information = [&](const Pose& T_c_w) {
            ++work;
            return stripesThenTexture(T_c_w);
        };
        problem.clearance = [&](const Eigen::Vector3d&) {
            ++work;
            return 1.;
        };
        const auto planner = beliefPlanner(problem);
        planner->params().setParam("max_vertices", "150");
        planner->params().setParam("shortcut", "100");
        planner->solve(ob::PlannerTerminationCondition([&] { return work >= limit; }));
        EXPECT_LT(work, limit + kOneMotion);
        planner->solve(ob::plannerNonTerminatingCondition());
        EXPECT_EQ(planner->vertices(), 150U);
        EXPECT_LT(planner->bestCost(), 10.);
        EXPECT_LT(auditTree(*planner).maxCostError, 1e-9);
        most = std::max(most, work);
    }
}

/// A search that was stopped has not found out which vertices are of use.
TEST(Anytime, ASearchThatIsStoppedRejectsNoSamples) {
    const auto whole = beliefPlanner(Problem{});
    grow(*whole, 190);
    const auto stopped = beliefPlanner(Problem{});
    stopped->params().setParam("max_vertices", "190");
    std::size_t looks = 0;
    stopped->solve(ob::PlannerTerminationCondition(
        [&] { return stopped->vertices() >= BeliefRRTstar::kFirstSearch && ++looks > 50; }));
    EXPECT_EQ(stopped->vertices(), BeliefRRTstar::kFirstSearch);
    stopped->solve(ob::plannerNonTerminatingCondition());
    EXPECT_EQ(stopped->vertices(), 190U);
    EXPECT_LT(stopped->iterations(), whole->iterations() * 5 / 4);
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
    const double cost = planner->bestCost();
    EXPECT_NEAR(cost, same->bestCost(), 0.01 * cost);  // its first searches are earlier
    EXPECT_EQ(planner->solve(0.), ob::PlannerStatus::EXACT_SOLUTION);  // keeps what it has
    EXPECT_EQ(planner->bestCost(), cost);
}

}  // namespace
}  // namespace photonav::test
