// SPDX-License-Identifier: BSD-3-Clause
#include "problem/planning_problem.hpp"

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>

#include "geometry/camera.hpp"
#include "geometry/constants.hpp"
#include "map/map_fusion.hpp"
#include "planners/planner_table.hpp"
#include "render/mesh_renderer.hpp"
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

/// Absurd noise or information can overflow the cost of a path that is there.
TEST(PlanningProblem, APathWhoseCostIsNotFiniteHasFailed) {
    const Config config = smallProblem(0.5);
    const World world(config);
    const PlanningProblem problem(config, world);
    PlanOutcome outcome;
    outcome.vertices = 150;
    EXPECT_EQ(problem.statusOf(outcome), "no path: the goal was not reached by 150 vertices");
    for (const double cost : {kInfinity, kNone}) {
        outcome.path.emplace().cost = cost;
        EXPECT_EQ(outcome.status(), "failed");
        EXPECT_EQ(problem.statusOf(outcome), "failed: the cost of the path is not a finite number");
    }
    outcome.path->cost = 9.;
    EXPECT_EQ(problem.statusOf(outcome), "done");
}

TEST(PlanningProblem, EveryNamedPlannerIsMadeAndNoOther) {
    const Config config = smallProblem(0.5);
    const World world(config);
    PlanningProblem problem(config, world);
    for (const std::string& name : plannerNames()) {
        EXPECT_EQ(problem.makePlanner(name)->getName(), name);
    }
    EXPECT_EQ(
        test::messageOf<std::invalid_argument>([&] { problem.makePlanner("prm"); }),
        "no planner is named prm; the names are belief_rrt_star, pa_rrt_star, rrbt, rrt_star");
}

/// A wall, seen from where the body starts.
MapChange fuseWall(TexturedOcTree& map, const Config& config) {
    Scene wall;
    addBox(wall, {4., 1., 0.}, {4.2, 3., 3.}, addTexture(wall, valueNoise({})));
    const Camera camera = makeCamera(94, 60, 1.2);
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() = config.start.position;
    const Pose T_c_w = (T_w_b * cameraMount(0.)).inverse();
    View view;
    MeshRenderer(wall).render(camera, T_c_w, view);
    return fuse(map, view, camera, T_c_w);
}

/// With a camera that looks ahead, to see the wall.
Config emptySpace() {
    Config config;
    config.bounds = {Eigen::Vector3d(0., 0., 1.), Eigen::Vector3d(8., 4., 1.)};
    config.start.position = {1., 2., 1.};
    config.goal.position = {7., 2., 1.};
    config.vertices = 150;
    config.camera = {.mount = "forward", .width = 48, .height = 32};
    config.unknownToPlanner = UnknownPolicy::free;
    return config;
}

TEST(PlanningProblem, FollowsAMapThatChanges) {
    const Config config = emptySpace();
    const auto map = std::make_shared<TexturedOcTree>(0.1);
    World world(map, config);
    PlanningProblem problem(config, world);
    for (const std::string& name : plannerNames()) problem.makePlanner(name);  // and dropped
    const auto planner = problem.makePlanner("belief_rrt_star");
    const PlanOutcome before = problem.solve(planner);
    ASSERT_TRUE(before.isSolved());

    const MapChange change = fuseWall(*map, config);
    world.mapChanged(change);
    problem.mapChanged(change);
    const PlanOutcome after = problem.solve(planner);
    ASSERT_TRUE(after.isSolved());
    EXPECT_GT(after.path->length, before.path->length + 0.2);
    EXPECT_GT(after.path->points.front().information.trace(), 0.);

    const World fresh(map, config);
    PlanningProblem judge(config, fresh);
    std::vector<Place> waypoints;
    for (const BeliefPoint& point : after.path->points) {
        EXPECT_GT(fresh.clearance(point.T_w_b.translation()), config.robotRadius);
        if (point.isWaypoint) waypoints.push_back({point.T_w_b.translation(), {}});
    }
    EXPECT_EQ(judge.evaluate("again", waypoints).cost, after.path->cost);
    EXPECT_EQ(world.extent().max(), fresh.extent().max());
}

TEST(PlanningProblem, EvaluatesPathsOfOtherPlanners) {
    const Config config = smallProblem(0.5);
    const World world(config);
    PlanningProblem problem(config, world);
    ompl::geometric::PathGeometric path(problem.spaceInformation());
    ompl::base::ScopedState<> state(problem.spaceInformation());
    for (const Place& place : {config.start, config.goal}) {
        problem.space().setState(state.get(), place.position, 0.);
        path.append(state.get());
    }
    EXPECT_EQ(problem.evaluate("straight", path).cost,
              problem.evaluate("straight", {config.start, config.goal}).cost);
}

TEST(World, OnlyAMapOfTheProgramsOwnCanChange) {
    World world(smallProblem(0.1));
    EXPECT_THROW(world.mapChanged({}), std::logic_error);
}

TEST(World, HoldsWhatItWasMadeOf) {
    const World world(smallProblem(0.1));
    ASSERT_NE(world.scene(), nullptr);
    EXPECT_EQ(world.map(), nullptr);
    EXPECT_TRUE(world.extent().contains(world.scene()->boundingBox()));
}

}  // namespace
}  // namespace photonav
