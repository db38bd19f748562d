// SPDX-License-Identifier: BSD-3-Clause
// What planners keep, remove and grow again where walls appear and vanish.
#include <gtest/gtest.h>
#include <ompl/geometric/PathGeometric.h>

#include <random>

#include "planning/planners/changing_world.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

/// A planner above a changing world of walls.
struct PlannerBetweenWalls {
    explicit PlannerBetweenWalls(const std::string& name, std::size_t vertices = 200)
        : problem(problemIn(SceneKind::flat)), world(problem.bounds) {
        problem.clearance = world.clearance();
        if (name == "rrt_star") problem.belief.alpha = 1.;
        planner = problem.planner(name);
        if (name == "belief_rrt_star") planner->params().setParam("shortcut", "0");
        grow(*planner, vertices);
    }

    Problem problem;
    ChangingWorld world;
    std::shared_ptr<BeliefPlanner> planner;
};

class ChangedPlanner : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Planners, ChangedPlanner,
                         testing::Values("rrt_star", "pa_rrt_star", "rrbt", "belief_rrt_star"));

TEST_P(ChangedPlanner, VerticesInAWallAreRemoved) {
    PlannerBetweenWalls problem(GetParam());
    const std::size_t before = problem.planner->vertices();
    problem.planner->mapChanged(
        problem.world.fill({Vector3d(2., 3., 0.), Vector3d(6., 6., 4.)}, true));
    EXPECT_LT(problem.planner->vertices(), before - 15);  // of 200 in 64 m^2
    grow(*problem.planner, 250);
    for (const TreeNode& node : problem.planner->tree()) {
        EXPECT_TRUE(problem.planner->getSpaceInformation()->isValid(node.state));
    }
}

TEST_P(ChangedPlanner, CountsWhatAnUpdateChanges) {
    PlannerBetweenWalls problem(GetParam());
    BeliefPlanner& planner = *problem.planner;
    EXPECT_EQ(planner.lastUpdate().verticesAdded, planner.vertices() - 1);  // all but the start
    EXPECT_EQ(planner.lastUpdate().verticesRewired, 0U);
    const std::size_t before = planner.vertices();
    const Eigen::AlignedBox3d wall(Vector3d(2., 3., 0.), Vector3d(6., 6., 4.));
    planner.mapChanged(problem.world.fill(wall, true));
    const std::size_t left = planner.vertices();
    EXPECT_EQ(planner.lastUpdate().verticesInvalidated, before - left);
    EXPECT_GT(planner.lastUpdate().edgesInvalidated, 5U);
    EXPECT_EQ(planner.lastUpdate().verticesAdded, 0U);
    grow(planner, 250);
    EXPECT_EQ(planner.lastUpdate().verticesInvalidated, before - left);
    EXPECT_EQ(planner.lastUpdate().verticesAdded, planner.vertices() - left);
    EXPECT_GT(planner.lastUpdate().verticesRewired, 0U);
    EXPECT_LT(planner.lastUpdate().verticesRewired, left);
}

/// The places where a robot has been are no samples: they do not fill a graph of limited size.
TEST_P(ChangedPlanner, GrowsAgainAfterManyMovesOfItsRoot) {
    PlannerBetweenWalls problem(GetParam());
    BeliefPlanner& planner = *problem.planner;
    ob::ScopedState<> place(planner.getSpaceInformation());
    problem.problem.space().setState(place.get(), problem.problem.start, 0.);
    const Belief belief = planner.model().root(place.get());
    for (int i = 0; i < 60; ++i) {  // hovers, and drifts a little
        const Vector3d drift(0.02 * (i % 5), 0.02 * (i % 7), 0.);
        problem.problem.space().setState(place.get(), problem.problem.start + drift, 0.);
        planner.moveRoot(place.get(), belief);
        grow(planner, 200);
    }
    EXPECT_EQ(planner.samples(), 200U);
    EXPECT_LT(planner.vertices(), 230U);
    planner.mapChanged(problem.world.fill({Vector3d(2., 3., 0.), Vector3d(6., 6., 4.)}, true));
    EXPECT_GT(planner.lastUpdate().verticesInvalidated, 15U);
    grow(planner, 200);
    EXPECT_GE(planner.samples(), 200U);
    EXPECT_LE(planner.samples(), GetParam() == "belief_rrt_star" ? 240U : 200U);
    EXPECT_GE(planner.lastUpdate().verticesAdded, planner.lastUpdate().verticesInvalidated);
}

/// A wall on the part of the best path that the robot has flown leaves the rest as it is, told
/// before the root has moved or after; one ahead of it does not.
TEST_P(ChangedPlanner, AWallBehindTheRobotDoesNotBlockItsWay) {
    for (const bool isBehind : {true, false}) {
        for (const bool isMovedFirst : {false, true}) {
            PlannerBetweenWalls problem(GetParam());
            BeliefPlanner& planner = *problem.planner;
            const FlightSpace& space = planner.model().space();
            const auto& path = planner.bestPath();
            const std::size_t middle = path.size() / 2;
            ASSERT_GE(middle, 1U);
            const Vector3d end = space.position(path.back());
            const Vector3d here =
                0.5 * (space.position(path[middle - 1]) + space.position(path[middle]));
            const Vector3d wall = isBehind ? space.position(path.front()) : end;
            ASSERT_GT((wall - here).norm(), 1.);
            const Vector3d half(0.2, 0.2, 2.);
            ob::ScopedState<> root(planner.getSpaceInformation());
            space.setState(root.get(), here, 0.);
            const Belief belief = planner.model().root(root.get());
            if (isMovedFirst) planner.moveRoot(root.get(), belief);
            planner.mapChanged(problem.world.fill({wall - half, wall + half}, true));
            EXPECT_EQ(planner.bestPath().empty(), !isMovedFirst || !isBehind);
            if (!isMovedFirst) planner.moveRoot(root.get(), belief);
            ASSERT_EQ(planner.bestPath().empty(), !isBehind);
            if (!isBehind) continue;
            EXPECT_EQ(space.position(planner.bestPath().front()), here);
            EXPECT_EQ(space.position(planner.bestPath().back()), end);
            EXPECT_TRUE(planner.getProblemDefinition()->hasExactSolution());
        }
    }
}

/// The positions of a planner's vertices that have a belief.
std::vector<Vector3d> positionsOf(const BeliefPlanner& planner) {
    std::vector<Vector3d> positions;
    for (const TreeNode& node : planner.tree()) {
        positions.push_back(planner.model().space().position(node.state));
    }
    return positions;
}

double distanceTo(const std::vector<Vector3d>& points, const Vector3d& p) {
    double least = kInfinity;
    for (const Vector3d& point : points) least = std::min(least, (point - p).norm());
    return least;
}

TEST(ChangedTree, IsGrownAgainWhereItsSubtreesWere) {
    for (const std::string name : {"rrt_star", "pa_rrt_star"}) {
        PlannerBetweenWalls problem(name, 300);
        BeliefPlanner& planner = *problem.planner;
        const auto before = positionsOf(planner);
        planner.mapChanged(problem.world.fill({Vector3d(5., 1., 0.), Vector3d(5.4, 3., 4.)}, true));
        const auto kept = positionsOf(planner);
        std::vector<Vector3d> removed;
        for (const Vector3d& p : before) {
            if (distanceTo(kept, p) > 0.) removed.push_back(p);
        }
        ASSERT_GT(removed.size(), 10U);
        ASSERT_LT(removed.size(), 150U);
        grow(planner, 300);
        double added = 0., nearby = 0.;
        for (const Vector3d& p : positionsOf(planner)) {
            if (distanceTo(kept, p) == 0.) continue;
            ++added;
            nearby += distanceTo(removed, p) < 1. ? 1. : 0.;
        }
        EXPECT_EQ(added, removed.size());
        EXPECT_GT(nearby / added, 0.9) << name;
    }
}

TEST_P(ChangedPlanner, AnUpdateThatChangesNothingCountsNothing) {
    PlannerBetweenWalls problem(GetParam());
    BeliefPlanner& planner = *problem.planner;
    MapChange nothing{.resolution = 0.2};
    nothing.occupancy.emplace_back(1000, 1000, 0);  // far away
    planner.mapChanged(nothing);
    grow(planner, planner.vertices());
    planner.mapChanged(nothing);
    grow(planner, planner.vertices());
    const UpdateCounts& counts = planner.lastUpdate();
    EXPECT_EQ(counts.verticesInvalidated, 0U);
    EXPECT_EQ(counts.edgesInvalidated, 0U);
    EXPECT_EQ(counts.verticesAdded, 0U);
    EXPECT_EQ(counts.verticesRewired, 0U);
}

TEST_P(ChangedPlanner, AMoveBelongsToTheUpdateOfTheMapBeforeIt) {
    PlannerBetweenWalls problem(GetParam());
    BeliefPlanner& planner = *problem.planner;
    planner.mapChanged(problem.world.fill({Vector3d(2., 3., 0.), Vector3d(6., 6., 4.)}, true));
    const std::size_t invalidated = planner.lastUpdate().verticesInvalidated;
    ob::ScopedState<> state(planner.getSpaceInformation());
    problem.problem.space().setState(state.get(), Vector3d(1.2, 1.1, 2.), 0.);
    planner.moveRoot(state.get(), Belief{});
    EXPECT_GE(planner.lastUpdate().verticesInvalidated, invalidated);
    grow(planner, 210);
    planner.moveRoot(state.get(), Belief{});
    EXPECT_LT(planner.lastUpdate().verticesInvalidated, invalidated);
    EXPECT_EQ(planner.lastUpdate().verticesAdded, 0U);
}

/// Planners over a textured floor that share the information of its views.
class PlannersOverTexture : public testing::TestWithParam<std::string> {
  protected:
    PlannersOverTexture() {
        problem.clearance = world.clearance();
        paint(kFloor);
    }
    std::shared_ptr<BeliefPlanner> planner() {
        const auto model = std::make_shared<BeliefModel>(problem.space(), field, problem.belief);
        auto planner = problem.planner(GetParam(), 5, model);
        grow(*planner, 120);
        return planner;
    }
    MapChange paint(const Eigen::AlignedBox2d& area) {
        return world.paintFloor(area, [&] { return std::generate_canonical<float, 24>(random); });
    }
    void makeField(unsigned updatesUntilStale) {
        const Camera camera = makeCamera(24, 16, 1.2);
        field = std::make_shared<InformationField>(
            world.freshViews(), camera, photometricModel(camera, {}), problem.mount,
            InformationField::Options{.positionPitch = 0.25,
                                      .updatesUntilStale = updatesUntilStale});
    }

    std::mt19937 random{1};
    Problem problem = problemIn(SceneKind::overTexture);
    ChangingWorld world{problem.bounds};
    std::shared_ptr<InformationField> field;
};
INSTANTIATE_TEST_SUITE_P(Planners, PlannersOverTexture,
                         testing::Values("pa_rrt_star", "rrbt", "belief_rrt_star"));

/// The first one renders the views again that both have in common.
TEST_P(PlannersOverTexture, BothFollowAChange) {
    makeField(1);
    const auto first = planner(), second = planner();
    ASSERT_EQ(first->bestCost(), second->bestCost());
    const MapChange change = paint({Eigen::Vector2d(1., 1.), Eigen::Vector2d(6., 6.)});
    field->update(world.freshViews(), change);
    for (const auto& planner : {first, second}) {
        planner->mapChanged(change);
        grow(*planner, 120);
        EXPECT_LT(auditTree(*planner).maxCostError, 1e-9);
    }
    EXPECT_EQ(first->bestCost(), second->bestCost());
    EXPECT_EQ(first->lastUpdate().verticesRewired, second->lastUpdate().verticesRewired);
}

/// Some views become stale at the next update only, although nothing changes then.
TEST_P(PlannersOverTexture, FollowViewsThatBecomeStaleLater) {
    makeField(2);
    const auto planner = this->planner();
    MapChange change = paint({Eigen::Vector2d(1., 1.), Eigen::Vector2d(6., 6.)});
    for (int update = 0; update < 2; ++update) {
        field->update(world.freshViews(), change);
        EXPECT_GT(field->stale(), 0U);
        planner->mapChanged(change);
        EXPECT_LT(auditTree(*planner).maxCostError, 1e-9) << "update " << update;
        change = {.resolution = change.resolution};
    }
}

TEST(ChangedBeliefRRTstar, SearchesAfterAChangeFindWhatASearchAnewFinds) {
    PlannerBetweenWalls problem("belief_rrt_star");
    std::mt19937 random(3);
    std::uniform_real_distribution<double> at(0., 4.);
    for (int step = 0; step < 12; ++step) {
        SCOPED_TRACE(step);
        const Vector3d low(at(random), at(random), 0.);
        const Eigen::AlignedBox3d wall(low, low + Vector3d(4., 4., 4.));
        problem.planner->mapChanged(problem.world.fill(wall, true));
        problem.planner->mapChanged(problem.world.fill(wall, false));
        grow(*problem.planner, 200);  // where vertices were removed, numbers are used again
        const double cost = problem.planner->bestCost();
        MapChange nothing{.resolution = 0.2};
        nothing.occupancy.emplace_back(1000, 1000, 0);  // far away
        problem.planner->mapChanged(nothing);
        grow(*problem.planner, 200);
        EXPECT_NEAR(problem.planner->bestCost(), cost, 1e-9);
    }
}

/// A way that is flown already is not left for one that is little better.
TEST(ChangedBeliefRRTstar, LeavesAWayOnlyForOneThatIsWorthIt) {
    const Eigen::AlignedBox3d wall(Vector3d(2., 2., 0.), Vector3d(6., 5., 4.));
    for (const double commitment : {0., 0.9}) {
        PlannerBetweenWalls problem("belief_rrt_star");
        problem.planner->params().setParam("commitment", std::to_string(commitment));
        problem.planner->mapChanged(problem.world.fill(wall, true));
        grow(*problem.planner, 200);
        const double around = problem.planner->bestCost();
        problem.planner->mapChanged(problem.world.fill(wall, false));
        grow(*problem.planner, 400);
        if (commitment == 0.) {
            EXPECT_LT(problem.planner->bestCost(), 0.99 * around);
        } else {
            EXPECT_NEAR(problem.planner->bestCost(), around, 1e-9);
        }
    }
}

/// What is left of a sparse graph may have no way through a door beside the blocked one.
TEST(ChangedBeliefRRTstar, GrowsWhereItsBestPathWasBlocked) {
    constexpr std::size_t kVertices = 60;
    PlannerBetweenWalls problem("belief_rrt_star", kVertices);
    BeliefPlanner& planner = *problem.planner;
    const Eigen::AlignedBox3d wall(Vector3d(0., 4., 0.), Vector3d(8., 4.4, 4.));
    const auto block = [&] {
        planner.mapChanged(problem.world.fill(wall, true));
        ASSERT_TRUE(planner.bestPath().empty());
        grow(planner, kVertices);
    };
    block();
    const UpdateCounts counts = planner.lastUpdate();
    const std::size_t left = kVertices - counts.verticesInvalidated;
    EXPECT_EQ(counts.verticesAdded, counts.verticesInvalidated + left / 5);  // there is no detour
    for (int i = 0; i < 20; ++i) {
        planner.mapChanged(problem.world.fill(wall, false));
        grow(planner, kVertices);
        ASSERT_LT(planner.bestCost(), kInfinity);
        block();
    }
    EXPECT_GT(planner.samples(), kVertices + left / 5);
    EXPECT_LE(planner.samples(), 2 * kVertices);  // it does not grow for ever
}

TEST(ChangedBeliefRRTstar, AChangedRoadmapIsSearchedBeforeItGrows) {
    PlannerBetweenWalls problem("belief_rrt_star", 80);
    const auto path = problem.planner->getProblemDefinition()->getSolutionPath();
    const auto& states = path->as<ompl::geometric::PathGeometric>()->getStates();
    ASSERT_GT(states.size(), 2U);
    Vector3d corner = problem.problem.space().position(states[states.size() / 2]);
    corner.z() = 0.;
    const Vector3d size(0.3, 0.3, 4.);
    problem.planner->mapChanged(problem.world.fill({corner - size, corner + size}, true));
    ASSERT_EQ(problem.planner->bestCost(), kInfinity);
    const std::size_t last = problem.planner->iterations() + 1;
    problem.planner->solve(
        ob::PlannerTerminationCondition([&] { return problem.planner->iterations() >= last; }));
    EXPECT_LT(problem.planner->bestCost(), kInfinity);
}

}  // namespace
}  // namespace photonav::test
