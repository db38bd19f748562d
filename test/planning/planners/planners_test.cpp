// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/goals/GoalStates.h>

#include <atomic>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "planning/solution_checks.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

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
        for (const std::size_t vertices : {std::size_t{7}, std::size_t{40} + seed, treeOf(180),
                                           treeOf(500)}) {  // prefixes of one tree
            grow(*planner, vertices);
            expectBeliefsToReplay(*planner);
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
        expectBeliefsToReplay(*planner);
    }
}

TEST_P(EveryPlanner, CostNeverRisesAndIsTheCostOfThePath) {
    Problem problem;
    const auto planner = problem.planner(GetParam());
    double last = kInfinity;
    for (std::size_t vertices = 100; vertices <= treeOf(800); vertices += 100) {
        grow(*planner, vertices);
        EXPECT_LE(planner->bestCost(), last);
        last = planner->bestCost();
    }
    if (GetParam() != "rrt_star")
        EXPECT_NEAR(replayedCost(*planner), last, 1e-9 * last);
    else
        EXPECT_NEAR(solution(*planner).length(), last, 1e-9 * last);
}

TEST_P(EveryPlanner, IsDeterministicForASeed) {
    Problem problem;
    const auto once = problem.planner(GetParam());
    const auto twice = problem.planner(GetParam());
    grow(*once, treeOf(300));
    grow(*twice, treeOf(300));
    EXPECT_EQ(once->iterations(), twice->iterations());
    EXPECT_DOUBLE_EQ(once->bestCost(), twice->bestCost());
    const auto other = problem.planner(GetParam());
    EXPECT_TRUE(other->params().setParam("seed", "99"));
    grow(*other, treeOf(300));
    EXPECT_NE(once->bestCost(), other->bestCost());
}

TEST_P(EveryPlanner, ResumesWhereItWas) {
    Problem problem;
    const auto once = problem.planner(GetParam());
    const auto twice = problem.planner(GetParam());
    grow(*once, 300);
    grow(*twice, 120);
    const double before = twice->bestCost();
    grow(*twice, 300);
    EXPECT_EQ(once->vertices(), twice->vertices());
    EXPECT_LE(twice->bestCost(), before);
    // What belief_rrt_star found before it paused steers what it samples next.
    if (GetParam() != "belief_rrt_star") {
        EXPECT_DOUBLE_EQ(once->bestCost(), twice->bestCost());
    }
}

TEST_P(EveryPlanner, IsUsableAfterAnExceptionInAView) {
    if (GetParam() == "rrt_star") GTEST_SKIP() << "renders no views";
    int viewsLeft = 150;
    Problem failing;
    failing.information = [&viewsLeft](const Pose& T_c_w) {
        if (viewsLeft-- == 0) throw std::runtime_error("no picture");
        return stripesThenTexture(T_c_w);
    };
    const auto planner = failing.planner(GetParam());
    EXPECT_THROW(grow(*planner, 300), std::runtime_error);
    planner->tree();
    planner->clear();
    planner->getProblemDefinition()->clearSolutionPaths();
    grow(*planner, 300);
    const auto fresh = Problem{}.planner(GetParam());
    grow(*fresh, 300);
    EXPECT_DOUBLE_EQ(planner->bestCost(), fresh->bestCost());
    expectBeliefsToReplay(*planner);
}

TEST_P(EveryPlanner, TakesTheBestOfSeveralStartsAndGoals) {
    Problem problem;
    problem.information = [](const Pose&) { return Matrix6::Zero().eval(); };
    const auto planner = problem.planner(GetParam());
    const auto si = planner->getSpaceInformation();
    auto definition = std::make_shared<ob::ProblemDefinition>(si);
    auto goals = std::make_shared<ob::GoalStates>(si);
    ob::ScopedState<> state(si);
    const auto at = [&](double x, double y) {
        problem.space().setState(state.get(), {x, y, 2.}, 0.);
        return state;
    };
    definition->addStartState(at(1., 1.));
    definition->addStartState(at(7., 3.));
    goals->addState(at(1., 9.));
    goals->addState(at(7., 7.));
    definition->setGoal(goals);
    planner->clear();
    planner->setProblemDefinition(definition);
    grow(*planner, 500);
    const auto& states = solution(*planner).getStates();
    EXPECT_TRUE(problem.space().position(states.front()).isApprox(Vector3d(7., 3., 2.)));
    EXPECT_TRUE(problem.space().position(states.back()).isApprox(Vector3d(7., 7., 2.)));
    EXPECT_LT(solution(*planner).length(), 4.3);
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
    const auto si = planner->getSpaceInformation();
    ob::PlannerData data(si);
    planner->getPlannerData(data);
    ASSERT_EQ(data.numStartVertices(), 1U);
    ASSERT_EQ(data.numGoalVertices(), 1U);
    EXPECT_TRUE(
        problem.space().position(data.getStartVertex(0).getState()).isApprox(problem.start));
    EXPECT_TRUE(problem.space().position(data.getGoalVertex(0).getState()).isApprox(problem.goal));
    EXPECT_GT(data.numVertices(), 20U);
    EXPECT_GE(data.numEdges() + 1, data.numVertices());
    for (unsigned i = 0; i < data.numVertices(); ++i) {
        std::vector<unsigned> next;
        data.getEdges(i, next);
        for (const unsigned j : next) {
            ob::Cost weight;
            ASSERT_TRUE(data.getEdgeWeight(i, j, &weight));
            EXPECT_NEAR(weight.value(),
                        si->distance(data.getVertex(i).getState(), data.getVertex(j).getState()),
                        1e-12);
        }
    }
    std::ostringstream text;
    data.printGraphML(text);
    const auto count = [&](const std::string& word) {
        unsigned n = 0;
        for (auto at = text.str().find(word); at != std::string::npos;
             at = text.str().find(word, at + 1)) {
            ++n;
        }
        return n;
    };
    EXPECT_EQ(count("<node id"), data.numVertices());
    EXPECT_EQ(count("<edge id"), data.numEdges());
}

TEST_P(EveryPlanner, SolutionsCompareByOurCost) {
    const auto planner = Problem{}.planner(GetParam());
    grow(*planner, 150);
    grow(*planner, treeOf(600));
    const auto solutions = planner->getProblemDefinition()->getSolutions();
    ASSERT_EQ(solutions.size(), 2U);
    EXPECT_DOUBLE_EQ(solutions[0].cost_.value(), planner->bestCost());
    EXPECT_LE(solutions[0].cost_.value(), solutions[1].cost_.value());
    EXPECT_NE(solutions[0].opt_->getDescription().find("length"), std::string::npos);
    // What OMPL can add up over the path is a lower bound.
    EXPECT_LE(solutions[0].path_->cost(solutions[0].opt_).value(), planner->bestCost() + 1e-9);
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

TEST_P(EveryPlanner, ProgressCanBeReadFromAnotherThread) {
    const auto planner = Problem{}.planner(GetParam());
    std::atomic<bool> isDone = false;
    std::atomic<std::size_t> length = 0;
    std::thread reader([&] {
        while (!isDone) {
            for (const auto& [name, value] : planner->getPlannerProgressProperties()) {
                length += value().size();
            }
        }
    });
    while (length == 0) std::this_thread::yield();
    grow(*planner, treeOf(200));
    isDone = true;
    reader.join();
    EXPECT_GE(planner->vertices(), treeOf(200));
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

/// Along a line, first away from the goal to texture and then back over the same places.
TEST(BeliefRRTstar, KeepsTheDetourOfARobotOnItsWayOut) {
    Problem problem;
    problem.bounds = box({0., 1., 2.}, {10., 1., 2.});
    problem.start = {5., 1., 2.};
    problem.goal = {1., 1., 2.};
    problem.belief.initialCovariance = 0.2 * Matrix6::Identity();
    const auto planner = problem.planner("belief_rrt_star");
    EXPECT_EQ(grow(*planner, 100), ob::PlannerStatus::EXACT_SOLUTION);
    const auto farthest = [&] {
        double x = 0.;
        for (const ob::State* state : planner->bestPath()) {
            x = std::max(x, problem.space().position(state).x());
        }
        return x;
    };
    ASSERT_GT(farthest(), 6.);
    ob::ScopedState<> ahead(planner->getSpaceInformation());
    problem.space().setState(ahead.get(), {5.4, 1., 2.}, 0.);
    planner->moveRoot(ahead.get(), {problem.belief.initialCovariance, 0.});
    EXPECT_GT(farthest(), 6.);
}

/// The limit on samples is to end the search for a path that does not exist, not a long flight.
TEST_P(EveryPlanner, GrowsAgainAfterAChange) {
    const Problem problem;
    const auto planner = problem.planner(GetParam());
    planner->params().setParam("max_iterations", "100");
    const ob::PlannerTerminationCondition never([] { return false; });
    planner->solve(never);
    planner->solve(never);
    EXPECT_EQ(planner->iterations(), 100U);
    ob::ScopedState<> ahead(planner->getSpaceInformation());
    problem.space().setState(ahead.get(), problem.start + Vector3d(0., 0.3, 0.), 0.);
    planner->moveRoot(ahead.get(), {problem.belief.initialCovariance, 0.});
    planner->solve(never);
    EXPECT_EQ(planner->iterations(), 200U);
    planner->mapChanged({.resolution = 0.1, .occupancy = {Eigen::Array3i(-100, 0, 0)}});
    planner->solve(never);
    EXPECT_EQ(planner->iterations(), 300U);
}

}  // namespace
}  // namespace photonav::test
