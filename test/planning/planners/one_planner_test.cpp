// SPDX-License-Identifier: BSD-3-Clause
// What one planner does that the others do not.
#include <gtest/gtest.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include "planning/solution_checks.hpp"

namespace photonav::test {
namespace {

TEST(RRTstar, RendersNoView) {
    const auto planner = Problem{}.planner("rrt_star");
    grow(*planner, 300);
    auditTree(*planner);
    EXPECT_EQ(planner->model().field().views(), 0U);
    EXPECT_EQ(planner->getName(), "rrt_star");
}

TEST(RRTstar, AgreesWithOmplOnPathLength) {
    ompl::RNG::setSeed(7);  // OMPL's planner draws from the process-wide sequence
    double ours = 0.;
    double ompls = 0.;
    const int seeds = 10;
    for (int seed = 1; seed <= seeds; ++seed) {
        Problem problem;
        problem.bounds = box({0, 0, 0}, {10, 10, 4});
        problem.clearance = sphereClearance;
        problem.start = {1., 5., 2.};
        problem.goal = {9., 5., 2.};
        problem.growth.seed = static_cast<std::uint32_t>(seed);
        const auto planner = problem.planner("rrt_star");
        const auto si = planner->getSpaceInformation();
        ompl::geometric::RRTstar reference(si);
        reference.setProblemDefinition(problem.definition(si));
        reference.setKNearest(false);
        reference.setRange(0.2 * si->getMaximumExtent());
        reference.setup();
        unsigned budget = 1500;
        reference.solve(ob::PlannerTerminationCondition([&] { return budget-- == 0; }));
        grow(*planner, reference.numIterations() > 0 ? 1500 : 0);
        ours += planner->bestCost() / seeds;
        ompls += reference.bestCost().value() / seeds;
    }
    EXPECT_NEAR(ours / ompls, 1., 0.015) << ours << " m against " << ompls << " m";
}

TEST(PerceptionRRTstar, KeepsItsBeliefsWhereOnlyTheLengthCounts) {
    Problem problem;
    problem.belief.alpha = 1.;
    const auto aware = problem.planner("pa_rrt_star");
    const auto shortest = problem.planner("rrt_star");
    grow(*aware, 300);
    grow(*shortest, 300);
    EXPECT_EQ(aware->getName(), "pa_rrt_star");
    EXPECT_GT(aware->model().field().views(), 0U);
    EXPECT_TRUE(aware->tree().back().covariance.has_value());
    EXPECT_DOUBLE_EQ(aware->bestCost(), shortest->bestCost());
}

TEST(PerceptionRRTstar, TakesALongerPathForCertainty) {
    const auto shortest = Problem{}.planner("rrt_star");
    const auto aware = Problem{}.planner("pa_rrt_star");
    grow(*shortest, 600);
    grow(*aware, 600);
    EXPECT_GT(solution(*aware).length(), solution(*shortest).length() + 2.);
    EXPECT_LT(aware->bestCost(), replayedCost(*shortest) + 1e-9);
}

/// Costs that fall along motions would make a vertex the child of its descendant.
TEST(PlannersWithBeliefs, EndWhereTheCovarianceIsNotPositive) {
    for (const std::string name : {"pa_rrt_star", "rrbt", "belief_rrt_star"}) {
        Problem problem;
        problem.information = [](const Pose&) -> Matrix6 { return Matrix6::Zero(); };
        const auto planner = problem.planner(name);
        ob::ScopedState<> start(planner->getSpaceInformation());
        problem.space().setState(start.get(), problem.start, 0.);
        planner->moveRoot(start.get(), {-1. * Matrix6::Identity(), 0.});
        EXPECT_EQ(grow(*planner, 150), ob::PlannerStatus::TIMEOUT) << name;
        EXPECT_EQ(planner->samples(), 150U) << name;
    }
}

TEST(BeliefRRTstar, CostsLessThanOneBeliefPerVertex) {
    double literal = 0.;
    double labels = 0.;
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
        Problem problem;
        problem.growth.seed = seed;
        const auto pa = problem.planner("pa_rrt_star");
        const auto belief = problem.planner("belief_rrt_star");
        grow(*pa, 600);
        grow(*belief, 600);
        EXPECT_LT(belief->bestCost(), pa->bestCost() + 1e-9);  // the same vertices, all edges
        literal += pa->bestCost();
        labels += belief->bestCost();
    }
    EXPECT_LT(labels, literal);
}

TEST(BeliefRRTstar, SearchesWhatItHasWhenItsSamplesRunOut) {
    Problem problem;
    problem.growth.goalBias = 0.5;
    problem.growth.maxIterations = 60;
    const auto planner = problem.planner("belief_rrt_star");
    planner->solve(ob::plannerNonTerminatingCondition());
    EXPECT_EQ(planner->iterations(), 60U);
    EXPECT_NEAR(replayedCost(*planner), planner->bestCost(), 1e-9);
    EXPECT_LT(planner->bestCost(), 50.);
}

/// Where all views inform, the bound is too low everywhere by about the same share.
TEST(BeliefRRTstar, ARaisedBoundLooksAtLessForNearlyTheSamePath) {
    Problem problem;
    problem.kind = StateKind::positionYaw;
    problem.bounds = box({0, 0, 1.5}, {10, 10, 2.5});
    problem.clearance = sphereClearance;
    problem.start = {1., 5., 2.};
    problem.goal = {9., 5., 2.};
    problem.information = [](const Pose& T_c_w) {
        return inRotatedAxes(vector6(900., 900., 400., 3e3, 3e3, 2e3).asDiagonal(), T_c_w.linear());
    };
    std::vector<double> cost, views;
    for (const char* inflation : {"0", "0.7"}) {
        const auto planner = problem.planner("belief_rrt_star");
        planner->params().setParam("shortcut", "0");
        planner->params().setParam("inflation", inflation);
        grow(*planner, 800);
        expectBeliefsToReplay(*planner);
        cost.push_back(planner->bestCost());
        views.push_back(static_cast<double>(planner->model().field().views()));
    }
    EXPECT_LT(views[1], 0.7 * views[0]);
    EXPECT_LT(cost[1], 1.05 * cost[0]);  // or less: the searches guide the samples
}

TEST(BeliefRRTstar, MoreLabelsAreNeverWorseHere) {
    std::vector<double> costs;
    for (const unsigned labels : {1U, 2U, 5U, 20U}) {
        const auto planner = Problem{}.planner("belief_rrt_star", labels);
        grow(*planner, 500);
        costs.push_back(planner->bestCost());
    }
    for (std::size_t i = 1; i < costs.size(); ++i) EXPECT_LE(costs[i], costs[i - 1] * 1.001);
}

}  // namespace
}  // namespace photonav::test
