// SPDX-License-Identifier: BSD-3-Clause
// Random sequences of walls that appear and vanish, of textures that change, and of moves of the
// robot.
#include <gtest/gtest.h>
#include <numeric>

#include "planning/planners/changing_flight.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

class ChangingMap : public testing::TestWithParam<std::tuple<std::string, SceneKind>> {};
std::string nameOf(const testing::TestParamInfo<std::tuple<std::string, SceneKind>>& test) {
    const std::array scenes{"_flat", "_with_heading", "_over_texture"};
    return std::get<0>(test.param) + scenes[static_cast<std::size_t>(std::get<1>(test.param))];
}

INSTANTIATE_TEST_SUITE_P(Planners, ChangingMap,
                         testing::Combine(testing::Values("rrt_star", "pa_rrt_star", "rrbt",
                                                          "belief_rrt_star"),
                                          testing::Values(SceneKind::flat, SceneKind::withHeading,
                                                          SceneKind::overTexture)),
                         nameOf);

TEST_P(ChangingMap, PathsAreValidAndAuditedAfterAnySequenceOfChanges) {
    int paths = 0;
    int kept = 0;
    constexpr int kSteps = 10;
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        ChangingFlight flight(std::get<0>(GetParam()), std::get<1>(GetParam()), seed);
        flight.plan();
        flight.check();
        for (int step = 0; step < kSteps && !HasFailure(); ++step) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", step " << step);
            flight.changeTheMap();
            flight.check();
            if (step % 2 == 1) flight.move();
            flight.check();
            kept += flight.hasPath();
            flight.plan();
            flight.check();
            paths += flight.hasPath();
        }
    }
    EXPECT_GT(paths, 20) << "of 30";
    EXPECT_GT(kept, 10) << "of 30";
}

TEST_P(ChangingMap, APathIsFoundAgainWhenGoalAndRobotAreFreeAgain) {
    ChangingFlight flight(std::get<0>(GetParam()), std::get<1>(GetParam()), 1);
    flight.plan();
    ASSERT_TRUE(flight.hasPath());
    for (const bool isGoal : {true, false, true}) {
        SCOPED_TRACE(isGoal ? "goal" : "robot");
        const Vector3d place = isGoal ? flight.goal() : flight.position();
        flight.wallAround(place, true);
        EXPECT_FALSE(flight.hasPath());
        flight.check();
        flight.plan();
        EXPECT_FALSE(flight.hasPath());
        flight.check();
        flight.wallAround(place, false);
        flight.check();
        flight.plan();
        EXPECT_TRUE(flight.hasPath());
        flight.check();
        flight.move();
        flight.check();
    }
}

TEST_P(ChangingMap, AStartThatIsBlockedAtFirstBecomesTheRootWhenItIsFree) {
    ChangingFlight flight(std::get<0>(GetParam()), std::get<1>(GetParam()), 1);
    flight.wallAround(flight.position(), true);
    flight.plan();
    EXPECT_FALSE(flight.hasPath());
    flight.wallAround(flight.position(), false);
    flight.plan();
    EXPECT_TRUE(flight.hasPath());
    flight.check();
}

/// The root may be given by the problem itself, whose start it replaces.
TEST_P(ChangingMap, TheRootMovesToTheStartOfTheProblem) {
    ChangingFlight flight(std::get<0>(GetParam()), std::get<1>(GetParam()), 1);
    flight.plan();
    BeliefPlanner& planner = flight.planner();
    const ob::State* start = planner.getProblemDefinition()->getStartState(0);
    planner.moveRoot(start, planner.model().root(start));
    flight.check();
    flight.plan();
    EXPECT_TRUE(flight.hasPath());
    flight.check();
}

class RepairedPlan : public testing::TestWithParam<SceneKind> {};
INSTANTIATE_TEST_SUITE_P(Scenes, RepairedPlan,
                         testing::Values(SceneKind::flat, SceneKind::withHeading,
                                         SceneKind::overTexture));

/// Seven random sequences of six updates: plans that follow the changes cost as much as those from
/// scratch with as many vertices.
TEST_P(RepairedPlan, CostsHardlyMoreThanOneFromScratch) {
    constexpr unsigned kShortcut = 1000;
    const std::string name = "belief_rrt_star";
    std::vector<double> excess;  // relative
    for (std::uint32_t seed = 11; seed <= 17; ++seed) {
        ChangingFlight flight(name, GetParam(), seed);
        flight.planner().params().setParam("shortcut", std::to_string(kShortcut));
        flight.plan();
        for (int step = 0; step < 6 && !HasFailure(); ++step) {
            flight.changeTheMap();
            if (step % 2 == 1) flight.move();
            flight.plan();
            flight.check();
            const double scratch = flight.costFromScratch(name, kShortcut);
            if (!flight.hasPath() || scratch == kInfinity) continue;
            excess.push_back(flight.planner().bestCost() / scratch - 1.);
        }
    }
    ASSERT_GT(excess.size(), 30U);
    std::sort(excess.begin(), excess.end());
    const double mean =
        std::accumulate(excess.begin(), excess.end(), 0.) / static_cast<double>(excess.size());
    std::printf(
        "J above that from scratch: mean %.2f %%, median %.2f %%, 90 %% %.2f %%, most %.2f %%\n",
        100. * mean, 100. * excess[excess.size() / 2], 100. * excess[excess.size() * 9 / 10],
        100. * excess.back());
    EXPECT_LT(mean, 0.02);
    EXPECT_LT(excess[excess.size() / 2], 0.02);
}

TEST(ChangedFloor, VerticesWhoseInformationChangedAreRewired) {
    ChangingFlight flight("pa_rrt_star", SceneKind::overTexture, 4);
    flight.plan();
    flight.plan();
    BeliefPlanner& planner = flight.planner();
    ASSERT_EQ(planner.vertices(), 250U);
    flight.paint({Eigen::Vector2d(4., 0.), Eigen::Vector2d(8., 5.)}, 0.8);
    const double before = planner.bestCost();
    flight.check();
    flight.plan();  // no vertex is added
    flight.check();
    EXPECT_EQ(planner.lastUpdate().verticesAdded, 0U);
    EXPECT_GT(planner.lastUpdate().verticesRewired, 5U);
    EXPECT_LT(planner.bestCost(), 0.99 * before);
}

/// The new texture is worth a detour to the planner's views, not to the reference model.
TEST(ChangedFloor, ReplacesAPathOnlyByOneOfLowerReferenceCost) {
    const auto lengthAfterPainting = [](bool isJudged, double& before) {
        ChangingFlight flight("belief_rrt_star", SceneKind::overTexture, 4);
        flight.plan();
        flight.plan();
        BeliefPlanner& planner = flight.planner();
        const auto length = [&] {
            return planner.getProblemDefinition()->getSolutionPath()->length();
        };
        if (isJudged) {
            const auto blind = std::make_shared<InformationField>(
                InformationFormula{}, planner.model().field().mount(), InformationField::Options{});
            planner.setReferenceModel(std::make_shared<BeliefModel>(planner.model().space(), blind,
                                                                    planner.model().options()));
        }
        before = length();
        flight.paint({Eigen::Vector2d(4., 0.), Eigen::Vector2d(8., 5.)}, 0.8);
        flight.plan();
        flight.check();
        return length();
    };
    double before = 0.;
    EXPECT_GT(lengthAfterPainting(false, before), 1.02 * before);
    EXPECT_EQ(lengthAfterPainting(true, before), before);
}

TEST(ChangedFloor, AComparisonThatIsStoppedKeepsThePathAndIsMadeLater) {
    ChangingFlight flight("belief_rrt_star", SceneKind::overTexture, 4);
    flight.plan();
    flight.plan();
    BeliefPlanner& planner = flight.planner();
    const double before = planner.getProblemDefinition()->getSolutionPath()->length();
    const auto blind = std::make_shared<InformationField>(
        InformationFormula{[](const Pose&) -> Matrix6 { return Matrix6::Zero(); }},
        planner.model().field().mount(), InformationField::Options{});
    planner.setReferenceModel(
        std::make_shared<BeliefModel>(planner.model().space(), blind, planner.model().options()));
    flight.paint({Eigen::Vector2d(4., 0.), Eigen::Vector2d(8., 5.)}, 0.8);
    planner.solve(ob::PlannerTerminationCondition([&] { return blind->views() >= 5; }));
    const std::size_t stopped = blind->views();
    EXPECT_LT(stopped, 50U);  // a motion
    EXPECT_EQ(planner.getProblemDefinition()->getSolutionPath()->length(), before);
    flight.plan();
    EXPECT_GT(blind->views(), stopped + 20);
    EXPECT_EQ(planner.getProblemDefinition()->getSolutionPath()->length(), before);
}

TEST(ChangedFloor, BeliefRRTstarRendersOnlyTheViewsThatItsSearchAsksFor) {
    ChangingFlight flight("belief_rrt_star", SceneKind::overTexture, 5);
    flight.paint(kFloor, 0.8);
    flight.plan();
    flight.plan();
    InformationField& field = flight.planner().model().field();
    const std::size_t views = field.views();
    flight.paint({Eigen::Vector2d(-2., 5.), Eigen::Vector2d(3., 10.)}, 0.8);  // off the path
    const std::size_t marked = field.stale();
    ASSERT_GT(marked, 50U);
    flight.plan();
    flight.check();
    EXPECT_LT(field.views() - views, marked / 2);
    EXPECT_GT(field.stale(), marked / 2);
}

}  // namespace
}  // namespace photonav::test
