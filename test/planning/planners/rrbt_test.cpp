// SPDX-License-Identifier: BSD-3-Clause
#include "planners/rrbt.hpp"

#include <gtest/gtest.h>
#include <ompl/geometric/PathGeometric.h>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

std::shared_ptr<RRBT> rrbt(const Problem& problem, double epsilon) {
    auto planner = std::dynamic_pointer_cast<RRBT>(problem.planner("rrbt"));
    planner->params().setParam("epsilon", std::to_string(epsilon));
    return planner;
}

/// A gate at (5, 6) with a long corridor to the goal behind it, and one place before the gate, off
/// the straight way, where the camera sees everything. At the gate the straight way is cheaper, at
/// the goal the detour is.
Problem detourBeforeTheGate() {
    Problem problem;
    problem.bounds = box({3, 0, 2}, {10, 15, 2});
    problem.start = {4., 1., 2.};
    problem.goal = {5., 14., 2.};
    problem.information = [](const Pose& T_c_w) {
        const Eigen::Vector3d p = T_c_w.inverse().translation();
        const bool sees = p.x() > 8. && p.y() > 4.;
        return Matrix6(sees ? Matrix6(1e4 * Matrix6::Identity()) : Matrix6(Matrix6::Zero()));
    };
    problem.clearance = [](const Eigen::Vector3d& p) {
        return p.y() > 6. ? 1. - std::abs(p.x() - 5.) : 1.;
    };
    problem.belief.alpha = 0.3;
    problem.belief.initialCovariance = vector6(.1, .1, .1, 1e-6, 1e-6, 1e-6).asDiagonal();
    problem.belief.motionNoise = vector6(1e-5, 1e-5, 1e-5, 1e-8, 1e-8, 1e-8).asDiagonal();
    problem.growth.range = 1.;
    return problem;
}

double farthest(const BeliefPlanner& planner) {
    double x = 0.;
    const auto path = planner.getProblemDefinition()->getSolutionPath();
    for (const auto* s : path->as<ompl::geometric::PathGeometric>()->getStates()) {
        x = std::max(x, planner.model().space().position(s).x());
    }
    return x;
}

TEST(RRBT, TakesTheDetourThatPaysAfterTheGate) {
    const Problem problem = detourBeforeTheGate();
    const auto all = rrbt(problem, 1e-3);
    const auto one = problem.planner("pa_rrt_star");
    grow(*all, 400);
    grow(*one, 400);
    EXPECT_GT(farthest(*all), 8.);  // where the camera sees
    EXPECT_LT(farthest(*one), 8.);  // cheapest to the gate, not to the goal
    EXPECT_LT(all->bestCost(), 0.9 * one->bestCost());
}

TEST(RRBT, WithALargeSlackOnlyTheCostCounts) {
    const auto planner = rrbt(detourBeforeTheGate(), 1e3);
    grow(*planner, 400);
    EXPECT_LT(farthest(*planner), 8.);
    const auto keeper = rrbt(detourBeforeTheGate(), 1e-3);
    grow(*keeper, 400);
    EXPECT_GT(keeper->beliefs(), planner->beliefs());
    EXPECT_LT(keeper->bestCost(), planner->bestCost());
}

TEST(RRBT, IsAsGoodAsTheLabelSearchOnTheSameVertices) {
    for (const std::uint32_t seed : {1U, 2U}) {
        Problem problem;
        problem.growth.seed = seed;
        const auto planner = rrbt(problem, 1e-4);
        const auto labels = problem.planner("belief_rrt_star", 20);
        labels->params().setParam("informed", "0");
        labels->params().setParam("shortcut", "0");
        grow(*planner, 250);
        grow(*labels, 250);
        EXPECT_NEAR(planner->bestCost() / labels->bestCost(), 1., 0.01);
    }
}

TEST(RRBT, KeepsNoBeliefThatAnotherBeats) {
    const auto planner = rrbt(Problem{}, 1e-4);
    grow(*planner, 150);
    const auto nodes = planner->tree();
    EXPECT_EQ(nodes.size(), planner->beliefs());
    for (const TreeNode& a : nodes) {
        for (const TreeNode& b : nodes) {
            if (a.state != b.state || a.cost >= b.cost) continue;
            const Matrix6 excess = *b.covariance - *a.covariance;
            EXPECT_NE(excess.llt().info(), Eigen::Success);
        }
    }
}

}  // namespace
}  // namespace photonav::test
