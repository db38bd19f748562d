// SPDX-License-Identifier: BSD-3-Clause
#include "problem/planning_problem.hpp"

#include <gtest/gtest.h>

#include "planners/planner_table.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

Config smallProblem(double alpha) {
    Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml",
                               {"planner.vertices=150", "planner.view_pitch=0.5"});
    config.belief.alpha = alpha;
    return config;
}

TEST(PlanningProblem, AnotherTradeOffSharesTheViews) {
    const Config config = smallProblem(0.1);
    const World world(config);
    PlanningProblem first(config, world);
    const PlanOutcome before = first.solve("belief_rrt_star");
    const PlanOutcome shared = PlanningProblem(first, 0.6).solve("belief_rrt_star");
    const PlanOutcome fresh = PlanningProblem(smallProblem(0.6), world).solve("belief_rrt_star");
    ASSERT_TRUE(shared.path && fresh.path);
    EXPECT_EQ(shared.path->cost, fresh.path->cost);
    EXPECT_EQ(shared.path->length, fresh.path->length);
    EXPECT_LT(shared.views - before.views, fresh.views);
}

TEST(PlanningProblem, PathsAreEvaluatedByWaypointsToo) {
    const Config config = smallProblem(0.5);
    const World world(config);
    PlanningProblem problem(config, world);
    const EvaluatedPath path =
        problem.evaluate("given", {config.start, {{6., 4., 2.}, {}}, config.goal});
    const auto positions = path.fromAbove();
    ASSERT_EQ(positions.size(), path.points.size());
    EXPECT_EQ(positions.front(), Eigen::Vector2d(config.start.position.head<2>()));
    EXPECT_EQ(positions.back(), Eigen::Vector2d(config.goal.position.head<2>()));
    EXPECT_NEAR(path.length, std::hypot(6., 4.) + std::hypot(4., 5.), 1e-9);
}

TEST(PlanningProblem, EveryNamedPlannerIsMadeAndNoOther) {
    const Config config = smallProblem(0.5);
    const World world(config);
    const PlanningProblem problem(config, world);
    for (const std::string& name : plannerNames()) {
        EXPECT_EQ(problem.makePlanner(name)->getName(), name);
    }
    EXPECT_EQ(
        test::messageOf<std::invalid_argument>([&] { problem.makePlanner("prm"); }),
        "no planner is named prm; the names are belief_rrt_star, pa_rrt_star, rrbt, rrt_star");
}

TEST(World, HoldsWhatItWasMadeOf) {
    const World world(smallProblem(0.1));
    ASSERT_NE(world.scene(), nullptr);
    EXPECT_EQ(world.map(), nullptr);
    EXPECT_TRUE(world.extent().contains(world.scene()->boundingBox()));
}

}  // namespace
}  // namespace photonav
