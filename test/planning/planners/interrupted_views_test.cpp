// SPDX-License-Identifier: BSD-3-Clause
// Planners whose views are stopped while they are rendered.
#include <gtest/gtest.h>
#include <ompl/base/goals/GoalStates.h>

#include <random>

#include "io/interrupted.hpp"
#include "planning/planners/changing_world.hpp"
#include "planning/solution_checks.hpp"

namespace photonav::test {
namespace {

class InterruptedViews : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Planners, InterruptedViews,
                         testing::Values("pa_rrt_star", "rrbt", "belief_rrt_star"),
                         [](const auto& test) { return test.param; });

/// Counts the views, and stops at one of them.
InformationFormula stoppedAt(int last, int& views) {
    return [last, &views](const Pose& T_c_w) {
        if (views++ == last) throw Interrupted();
        return stripesThenTexture(T_c_w);
    };
}

/// OMPL's benchmark does not expect exceptions.
TEST_P(InterruptedViews, EndASearchThatKnowsOfTheInterruption) {
    bool isInterrupted = false;
    int views = 0;
    Problem problem;
    problem.information = [&](const Pose& T_c_w) {
        isInterrupted = ++views > 3;
        if (isInterrupted) throw Interrupted();
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
        problem.information = stoppedAt(last, views);
        const auto planner = problem.planner(GetParam());
        try {
            const bool isSolved = grow(*planner, 150) == ob::PlannerStatus::EXACT_SOLUTION;
            if (views <= last) break;
            EXPECT_TRUE(isSolved) << last;
            EXPECT_TRUE(std::isfinite(planner->bestCost())) << last;
            ++paths;
            static_cast<void>(planner->tree());
        } catch (const Interrupted&) {
            EXPECT_FALSE(std::isfinite(planner->bestCost())) << last;
            ++stops;
        }
        planner->clear();
        EXPECT_EQ(grow(*planner, 150), ob::PlannerStatus::EXACT_SOLUTION) << last;
    }
    EXPECT_GT(stops, 3);
    EXPECT_GT(paths, 0);
}

/// Goals of a problem, in a row.
void setGoals(BeliefPlanner& planner, const Problem& problem, const std::vector<double>& xs) {
    const auto goals = std::make_shared<ob::GoalStates>(planner.getSpaceInformation());
    ob::ScopedState<> goal(planner.getSpaceInformation());
    for (const double x : xs) {
        problem.space().setState(goal.get(), {x, 9., 2.}, 0.);
        goals->addState(goal);
    }
    planner.getProblemDefinition()->setGoal(goals);
}

/// At whatever view: a search that goes on where it was has whole beliefs, and no goal without one.
TEST_P(InterruptedViews, SearchesGoOnWhereTheyWereStopped) {
    for (const std::vector<double>& goals : {std::vector{3.}, std::vector{3., 5., 7.}}) {
        int stops = 0;
        for (int last = 0;; last += 1 + last / 3) {
            int views = 0;
            Problem problem;
            problem.information = stoppedAt(last, views);
            const auto planner = problem.planner(GetParam());
            setGoals(*planner, problem, goals);
            try {
                grow(*planner, 150);
            } catch (const Interrupted&) {
            }
            if (views <= last) break;
            ++stops;
            EXPECT_EQ(grow(*planner, 180), ob::PlannerStatus::EXACT_SOLUTION) << last;
            EXPECT_GT(planner->bestPath().size(), 1U) << last;
            expectBeliefsToReplay(*planner);
        }
        EXPECT_GT(stops, 8);
    }
}

/// At whatever view of an update: no belief of the map before it is left.
TEST_P(InterruptedViews, LeaveNothingOfTheMapBeforeAnUpdate) {
    for (const bool isMove : {false, true}) {
        int stops = 0;
        for (int last = 0;; last += 1 + last / 3) {
            Problem problem = problemIn(SceneKind::overTexture);
            ChangingWorld world(problem.bounds);
            std::mt19937 random(1);
            std::uniform_real_distribution<float> grey(0.F, 1.F);
            const auto paint = [&] {
                return world.paintFloor(kFloor, [&] { return grey(random); });
            };
            paint();
            const Camera camera = makeCamera(24, 16, 1.2);
            int left = std::numeric_limits<int>::max();
            const auto field = std::make_shared<InformationField>(
                world.freshViews(), camera,
                [&, model = photometricModel(camera, {})](const View& view) {
                    if (left-- == 0) throw Interrupted();
                    return model(view);
                },
                problem.mount, InformationField::Options{});
            const auto planner = problem.planner(
                GetParam(), 5,
                std::make_shared<BeliefModel>(problem.space(), field, problem.belief));
            grow(*planner, 100);
            const MapChange change = paint();
            field->update(world.freshViews(), change);
            if (isMove) planner->mapChanged(change);
            ob::ScopedState<> root(planner->getSpaceInformation());
            problem.space().setState(root.get(), {1.3, 1.2, 2.}, 0.);
            left = last;
            try {
                if (isMove)
                    planner->moveRoot(root.get(), Belief{1e-3 * Matrix6::Identity(), 0.});
                else
                    planner->mapChanged(change);
                break;
            } catch (const Interrupted&) {
                ++stops;
            }
            EXPECT_EQ(grow(*planner, 100), ob::PlannerStatus::EXACT_SOLUTION);
            expectBeliefsToReplay(*planner);
        }
        EXPECT_TRUE(isMove || stops > 1);  // a move may need no new view
    }
}

}  // namespace
}  // namespace photonav::test
