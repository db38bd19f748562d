// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ompl/base/PlannerData.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include "fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

ompl::geometric::PathGeometric& solution(const BeliefPlanner& planner) {
    return *planner.getProblemDefinition()->getSolutionPath()->as<ompl::geometric::PathGeometric>();
}

double replayedCost(const BeliefPlanner& planner) {
    std::vector<const ob::State*> states;
    for (const ob::State* state : solution(planner).getStates()) states.push_back(state);
    return planner.model().evaluate(states).back().cost;
}

double sphereClearance(const Vector3d& p) { return (p - Vector3d(5, 5, 2)).norm() - 2.; }

void expectHonest(const BeliefPlanner& planner) {
    const Audit audit = auditTree(planner);
    EXPECT_GT(audit.nodes, 1U);
    EXPECT_LT(audit.maxCostError, 1e-9);
    EXPECT_LT(audit.maxCovarianceError, 1e-9);
}

class EveryPlanner : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Planners, EveryPlanner,
                         testing::Values("rrt_star", "pa_rrt_star", "rrbt", "belief_rrt_star"),
                         [](const auto& test) { return test.param; });

TEST_P(EveryPlanner, FindsAValidPathFromStartToGoal) {
    Problem problem;
    problem.clearance = sphereClearance;
    problem.start = {1., 5., 2.};
    problem.goal = {9., 5., 2.};
    const auto planner = problem.planner(GetParam());
    EXPECT_EQ(grow(*planner, 400), ob::PlannerStatus::EXACT_SOLUTION);
    auto& path = solution(*planner);
    EXPECT_TRUE(path.check());
    const auto space = problem.space();
    EXPECT_TRUE(space.position(path.getState(0)).isApprox(problem.start));
    EXPECT_TRUE(space.position(path.getStates().back()).isApprox(problem.goal));
    EXPECT_GT(path.length(), 8.5);  // around the sphere, not through it
}

TEST_P(EveryPlanner, StoredBeliefsSurviveRewiringAndResumption) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        Problem problem;
        problem.growth.seed = seed;
        const auto planner = problem.planner(GetParam());
        for (const std::size_t vertices : {7U, 40U + seed, 180U, 500U}) {  // prefixes of one tree
            grow(*planner, vertices);
            expectHonest(*planner);
        }
    }
}

TEST_P(EveryPlanner, AuditsWithHeadingAndInFullPose) {
    for (const StateKind kind : {StateKind::positionYaw, StateKind::se3}) {
        Problem problem;
        problem.kind = kind;
        problem.bounds = box({0, 0, 1}, {10, 10, 3});
        const auto planner = problem.planner(GetParam());
        grow(*planner, 150);
        expectHonest(*planner);
    }
}

TEST_P(EveryPlanner, CostNeverRisesAndIsTheCostOfThePath) {
    Problem problem;
    const auto planner = problem.planner(GetParam());
    double last = std::numeric_limits<double>::infinity();
    for (std::size_t vertices = 100; vertices <= 800; vertices += 100) {
        grow(*planner, vertices);
        EXPECT_LE(planner->bestCost(), last);
        last = planner->bestCost();
    }
    if (GetParam() != "rrt_star")
        EXPECT_NEAR(replayedCost(*planner), last, 1e-9 * last);
    else
        EXPECT_NEAR(solution(*planner).length(), last, 1e-9 * last);
}

TEST_P(EveryPlanner, IsDeterministicForASeedAndResumesWhereItWas) {
    Problem problem;
    const auto once = problem.planner(GetParam());
    const auto twice = problem.planner(GetParam());
    grow(*once, 300);
    grow(*twice, 120);
    grow(*twice, 300);
    EXPECT_EQ(once->iterations(), twice->iterations());
    EXPECT_DOUBLE_EQ(once->bestCost(), twice->bestCost());
    problem.growth.seed = 99;
    const auto other = problem.planner(GetParam());
    grow(*other, 300);
    EXPECT_NE(once->bestCost(), other->bestCost());
}

TEST_P(EveryPlanner, ClearForgetsEverything) {
    Problem problem;
    const auto planner = problem.planner(GetParam());
    grow(*planner, 200);
    const double cost = planner->bestCost();
    planner->clear();
    EXPECT_EQ(planner->vertices(), 0U);
    EXPECT_TRUE(std::isinf(planner->bestCost()));
    planner->getProblemDefinition()->clearSolutionPaths();
    grow(*planner, 200);
    EXPECT_DOUBLE_EQ(planner->bestCost(), cost);
}

TEST_P(EveryPlanner, PlannerDataIsATreeThatReachesTheGoal) {
    Problem problem;
    const auto planner = problem.planner(GetParam());
    grow(*planner, 200);
    ob::PlannerData data(planner->getSpaceInformation());
    planner->getPlannerData(data);
    EXPECT_EQ(data.numStartVertices(), 1U);
    EXPECT_EQ(data.numGoalVertices(), 1U);
    EXPECT_GT(data.numVertices(), 20U);
    EXPECT_GE(data.numEdges() + 1, data.numVertices());
}

TEST_P(EveryPlanner, ReportsProgressAndParameters) {
    Problem problem;
    const auto planner = problem.planner(GetParam());
    EXPECT_TRUE(planner->params().setParam("range", "1.5"));
    grow(*planner, 150);
    const auto& progress = planner->getPlannerProgressProperties();
    EXPECT_EQ(progress.at("vertices INTEGER")(), std::to_string(planner->vertices()));
    EXPECT_NEAR(std::stod(progress.at("best cost REAL")()), planner->bestCost(), 1e-5);
    EXPECT_EQ(progress.at("views INTEGER")() == "0", GetParam() == "rrt_star");
    for (const auto* state : solution(*planner).getStates()) EXPECT_NE(state, nullptr);
}

TEST_P(EveryPlanner, AnUnreachableGoalIsAStatusNotAnException) {
    Problem problem;  // a wall between start and goal
    problem.clearance = [](const Vector3d& p) { return std::abs(p.y() - 5.); };
    const auto planner = problem.planner(GetParam());
    EXPECT_FALSE(static_cast<bool>(grow(*planner, 200)));
    EXPECT_TRUE(std::isinf(planner->bestCost()));
}

TEST_P(EveryPlanner, AStartInCollisionIsAnInvalidStart) {
    Problem problem;
    problem.clearance = [](const Vector3d& p) { return p.y() - 2.; };
    const auto planner = problem.planner(GetParam());
    EXPECT_EQ(grow(*planner, 100), ob::PlannerStatus::INVALID_START);
}

TEST(RRTstar, NeverRendersAView) {
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

TEST(PerceptionRRTstar, GoesOutOfItsWayForCertainty) {
    const auto shortest = Problem{}.planner("rrt_star");
    const auto aware = Problem{}.planner("pa_rrt_star");
    grow(*shortest, 600);
    grow(*aware, 600);
    EXPECT_GT(solution(*aware).length(), solution(*shortest).length() + 2.);
    EXPECT_LT(aware->bestCost(), replayedCost(*shortest) + 1e-9);
}

TEST(BeliefRRTstar, BeatsOneBeliefPerVertex) {
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
