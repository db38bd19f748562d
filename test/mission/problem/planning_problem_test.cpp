// SPDX-License-Identifier: BSD-3-Clause
#include "problem/planning_problem.hpp"

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalStates.h>

#include "geometry/camera.hpp"
#include "geometry/constants.hpp"
#include "io/error.hpp"
#include "io/interrupted.hpp"
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

TEST(PlanningProblem, PathsBeginWithTheBeliefOfAMovedRoot) {
    const Config config = smallProblem(0.1);
    const World world(config);
    PlanningProblem problem(config, world);
    for (const char* name : {"belief_rrt_star", "rrt_star"}) {
        const auto planner = problem.makePlanner(name);
        ompl::base::ScopedState<> here(problem.spaceInformation());
        problem.space().setState(here.get(), {5., 2., 2.}, 0.);
        const Belief belief{1e-3 * Matrix6::Identity(), 1.5};
        planner->moveRoot(here.get(), belief);
        const PlanOutcome outcome = problem.solve(planner);
        ASSERT_TRUE(outcome.path) << name;
        EXPECT_LT(outcome.audit.maxCostError, 1e-9) << name;
        EXPECT_EQ(outcome.path->points.front().cost, 1.5) << name;
        EXPECT_NEAR(outcome.path->points.front().covariance.trace(), 6e-3, 1e-9) << name;
    }
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

/// Planners look at views of half the size, in the middle of cells; paths are evaluated by whole
/// views at their own poses.
TEST(PlanningProblem, QuickViewsRankAndExactViewsEvaluate) {
    Config config = smallProblem(0.1);
    config.quickViews = true;
    const World world(config);
    PlanningProblem problem(config, world);
    const auto planner = problem.makePlanner("belief_rrt_star");
    const Camera camera = config.camera.camera();
    for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d inCell(2.5 + 0.35 * i + 0.01, 1.13 + 0.35 * i, 2.1);
        const Pose T_w_b(Eigen::Translation3d{inCell});
        View view;
        world.views().render(camera, (T_w_b * config.camera.T_b_c()).inverse(), view);
        const Matrix6 exact = photometricInformation(view, camera, config.photometric);
        EXPECT_TRUE(problem.informationAt(T_w_b).isApprox(exact, 1e-4)) << i;
        const Pose T_w_centre(Eigen::Translation3d{(inCell / 0.5).array().round() * 0.5});
        const double whole = problem.informationAt(T_w_centre).topLeftCorner<3, 3>().trace();
        const double quick = planner->model().informationAt(T_w_b).topLeftCorner<3, 3>().trace();
        if (whole < 1.) continue;  // of a blank floor
        EXPECT_GT(quick / whole, 0.6) << i;
        EXPECT_LT(quick / whole, 1.6) << i;
    }
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
    config.belief.kappa = 2.5;  // not that of the shortest path, which depends on the map
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
    problem.followMap();
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

/// Called too early, a problem has nothing to follow; what it has missed is not lost.
TEST(PlanningProblem, FollowsAllChangesSinceItsLastCall) {
    const Config config = emptySpace();
    const auto map = std::make_shared<TexturedOcTree>(0.1);
    World world(map, config);
    PlanningProblem problem(config, world);
    const auto planner = problem.makePlanner("belief_rrt_star");
    const double before = problem.solve(planner).path->length;

    const MapChange wall = fuseWall(*map, config);
    problem.followMap();
    world.mapChanged(wall);
    PlanningProblem moved(std::move(problem));
    PlanningProblem other(moved, 0.7);  // over the same views, which are not up to date yet
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() = config.start.position;
    EXPECT_EQ(other.informationAt(T_w_b).trace(), 0.);
    map->updateNode(octomap::point3d(1.F, 0.4F, 1.F), true);
    MapChange more{.resolution = map->getResolution()};
    more.occupancy.emplace_back(2, 1, 2);
    world.mapChanged(more);
    other.followMap();
    EXPECT_GT(other.informationAt(T_w_b).trace(), 0.);
    moved.followMap();
    const PlanOutcome after = moved.solve(planner);
    ASSERT_TRUE(after.isSolved());
    EXPECT_GT(after.path->length, before + 0.2);
    EXPECT_GT(after.path->points.front().information.trace(), 0.);
}

/// A call that ends within a view is made up for by the next one, for all planners.
TEST(PlanningProblem, FollowsAgainWhatWasInterrupted) {
    const Config config = emptySpace();
    const auto map = std::make_shared<TexturedOcTree>(0.1);
    World world(map, config);
    bool isStopped = false;
    PlanningProblem problem(
        config, world, {}, [&](const Camera& camera, const PhotometricOptions& options) {
            return [&, model = photometricModel(camera, options)](const View& view) {
                if (isStopped) throw Interrupted();
                return model(view);
            };
        });
    const auto first = problem.makePlanner("belief_rrt_star");
    const auto second = problem.makePlanner("pa_rrt_star");
    const double before = problem.solve(first).path->length;
    problem.solve(second);

    world.mapChanged(fuseWall(*map, config));
    isStopped = true;
    EXPECT_THROW(problem.followMap(), Interrupted);
    isStopped = false;
    problem.followMap();
    for (const auto& planner : {first, second}) {
        const PlanOutcome after = problem.solve(planner);
        ASSERT_TRUE(after.isSolved());
        EXPECT_GT(after.path->length, before + 0.2);
        EXPECT_LT(after.audit.maxCostError, 1e-9);
    }
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

TEST(PlanningProblem, ItsTradeOffIsTheConfigsUnlessAnotherIsGiven) {
    const Config config = smallProblem(0.1);
    const World world(config);
    PlanningProblem given(config, world), other(config, world, 0.9);
    EXPECT_EQ(given.config().belief.alpha, 0.1);
    EXPECT_EQ(other.config().belief.alpha, 0.9);
    const std::vector<Place> straight{config.start, config.goal};
    const EvaluatedPath uncertain = given.evaluate("a", straight);
    const EvaluatedPath shorter = other.evaluate("b", straight);
    EXPECT_EQ(uncertain.goalTrace, shorter.goalTrace);
    EXPECT_GT(std::abs(uncertain.cost - shorter.cost), 0.1);
    EXPECT_EQ(other.makePlanner("belief_rrt_star")->model().options().alpha, 0.9);
}

/// Over white nothing corrects the pose, and the trace grows nearly linearly.
TEST(PlanningProblem, TheMeanTraceOfAPathIsItsMeanOverTheWay) {
    const Config config = smallProblem(0.1);
    const World world(config);
    const EvaluatedPath path =
        PlanningProblem(config, world).evaluate("white", {config.start, {{1., 4., 2.}, {}}});
    ASSERT_EQ(path.points.back().information, Matrix6::Zero());
    const double start = path.points.front().trace;
    const double growth = path.goalTrace - start;
    EXPECT_GT(growth, 0.01 * start);
    EXPECT_NEAR(path.meanTrace, start + 0.5 * growth, 0.2 * growth);
}

/// The problem of emptySpace() in a room, with a crate around a place.
World roomWithACrate(const Config& config, const Eigen::Vector3d& place) {
    Scene room;
    const auto texture = addTexture(room, valueNoise({.size = {8., 4.}, .seed = 1}));
    addBox(room, {-1., -1., 0.}, {9., 5., 3.}, texture, BoxInside::hollow);
    addBox(room, place - Eigen::Vector3d::Constant(0.3), place + Eigen::Vector3d::Constant(0.3),
           texture);
    return {std::move(room), config};
}

TEST(PlanningProblem, APlaceInCollisionIsNamed) {
    Config config = emptySpace();
    config.file = "room.yaml";
    for (const auto& [key, place] :
         {std::pair("start", config.start.position), std::pair("goal", config.goal.position)}) {
        const World world = roomWithACrate(config, place);
        const PlanningProblem problem(config, world);
        EXPECT_FALSE(problem.isFlyable(place));
        const std::string message = test::messageOf<InputError>([&] { problem.checkPlaces(); });
        EXPECT_EQ(message.find(std::string("room.yaml: ") + key + ": in collision: clearance"), 0U)
            << message;
    }
    const World world = roomWithACrate(config, {4., 0., 1.});
    EXPECT_NO_THROW(PlanningProblem(config, world).checkPlaces());
}

TEST(PlanningProblem, AGoalWithoutAHeadingIsReachedInAnyOfEight) {
    Config config = emptySpace();
    const World world = roomWithACrate(config, {4., 0., 1.});
    const auto goalsOf = [&] {
        const auto definition = PlanningProblem(config, world).definition();
        return definition->getGoal()->as<ompl::base::GoalStates>()->getStateCount();
    };
    EXPECT_EQ(goalsOf(), 1U);  // the heading is the start's
    config.space = StateKind::positionYaw;
    EXPECT_EQ(goalsOf(), 8U);
    config.goal.yaw = 1.;
    EXPECT_EQ(goalsOf(), 1U);
}

TEST(PlanningProblem, DescentKeepsToMotionsThatAreFree) {
    const Config config = emptySpace();
    const World world = roomWithACrate(config, {4., 2., 1.});
    PlanningProblem problem(config, world);
    const auto poses = [&](const std::vector<Place>& places) {
        std::vector<Pose> T_w_b(places.size(), Pose::Identity());
        for (std::size_t i = 0; i < places.size(); ++i) {
            T_w_b[i].translation() = places[i].position;
        }
        return T_w_b;
    };
    EXPECT_FALSE(problem.descend(poses({config.start, config.goal}), {}, kNotInterrupted));
    const std::vector<Place> around{config.start, {{4., 3.2, 1.}, {}}, config.goal};
    const auto best = problem.descend(poses(around), {}, kNotInterrupted);
    ASSERT_TRUE(best);
    EXPECT_LT(best->cost, problem.evaluate("around", around).cost);
}

TEST(PlanningProblem, EndsWhenItIsInterruptedAndGoesOnAfterwards) {
    const Config config = smallProblem(0.1);
    const World world(config);
    PlanningProblem problem(config, world);
    const std::atomic<bool> interrupted{true};
    const PlanOutcome ended = problem.solve("rrt_star", interrupted);
    EXPECT_LT(ended.vertices, config.vertices);
    EXPECT_EQ(problem.statusOf(ended).find("no path: "), 0U);
    EXPECT_NE(problem.statusOf(ended).find("then given up"), std::string::npos);
    std::size_t shown = 0;
    const PlanOutcome outcome =
        problem.solve("rrt_star", kNotInterrupted, [&](const PlanProgress&) { ++shown; });
    EXPECT_TRUE(outcome.isSolved());
    EXPECT_GE(shown, 4U);  // after every 50 vertices, and at the end
}

/// Its planner goes by penalties; the path is evaluated by the information of its views.
TEST(PlanningProblem, ThePlannersViewModelIsNotThatOfTheEvaluation) {
    Config config = smallProblem(0.5);
    config.viewModel.name = "feature_count";
    config.viewModel.kappa = 7.;
    const World world(config);
    PlanningProblem problem(config, world), usual(smallProblem(0.5), world);
    EXPECT_EQ(problem.makePlanner("rrt_star")->model().options().kappa, 7.);
    EXPECT_EQ(usual.makePlanner("rrt_star")->model().options().kappa, config.belief.kappa);
    const std::vector<Place> way{config.start, {{6., 4., 2.}, {}}, config.goal};
    EXPECT_EQ(problem.evaluate("a", way).cost, usual.evaluate("b", way).cost);
}

TEST(PlanningProblem, ViewsInformAsTheProgramSays) {
    const Config config = smallProblem(0.5);
    const World world(config);
    PlanningProblem problem(config, world, {}, [](const Camera&, const PhotometricOptions&) {
        return [](const View&) -> Matrix6 { return 4. * Matrix6::Identity(); };
    });
    EXPECT_NEAR(problem.informationAt(Pose::Identity()).trace(), 24., 1e-9);
}

TEST(PlanningProblem, ForgottenViewsAreRenderedAgain) {
    const Config config = smallProblem(0.1);
    const World world(config);
    PlanningProblem problem(config, world);
    const PlanOutcome first = problem.solve("belief_rrt_star");
    const PlanOutcome second = problem.solve("belief_rrt_star");
    EXPECT_EQ(second.views, first.views);
    EXPECT_GT(second.cacheHits, first.cacheHits);
    problem.forgetViews();
    const PlanOutcome anew = problem.solve("belief_rrt_star");
    EXPECT_EQ(anew.views, first.views);
    EXPECT_EQ(anew.cacheHits, first.cacheHits);
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
