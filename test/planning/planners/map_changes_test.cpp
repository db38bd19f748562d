// SPDX-License-Identifier: BSD-3-Clause
// Random sequences of walls that appear and vanish, of textures that change, and of moves of the
// robot.
#include <gtest/gtest.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/geometric/PathGeometric.h>

#include <numeric>
#include <random>

#include "map/distance_map.hpp"
#include "planning/fixture.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

/// Walls in a textured octree, and the clearance between them.
class ChangingWorld {
  public:
    explicit ChangingWorld(const Eigen::AlignedBox3d& bounds) : bounds_(bounds) {}

    /// Makes all cells in a box occupied or free.
    MapChange fill(const Eigen::AlignedBox3d& box, bool isOccupied) {
        MapChange change{.resolution = map_.getResolution()};
        const double cell = map_.getResolution();
        for (double z = box.min().z() + cell / 2; z < box.max().z(); z += cell) {
            for (double y = box.min().y() + cell / 2; y < box.max().y(); y += cell) {
                for (double x = box.min().x() + cell / 2; x < box.max().x(); x += cell) {
                    const octomap::OcTreeKey key = map_.coordToKey(x, y, z);
                    const auto* node = map_.search(key);
                    if (node != nullptr && map_.isNodeOccupied(node) == isOccupied) continue;
                    map_.setNodeValue(key, isOccupied ? 1.F : -1.F);
                    change.occupancy.push_back(brickOf(key));
                }
            }
        }
        change.normalize();
        clearance_ = freshClearance();
        return change;
    }

    /// Paints cells of the floor: random greys, or one grey for all.
    template <typename Grey>
    MapChange paintFloor(const Eigen::AlignedBox2d& area, const Grey& grey) {
        MapChange change{.resolution = map_.getResolution()};
        const double cell = map_.getResolution();
        for (double y = area.min().y() + cell / 2; y < area.max().y(); y += cell) {
            for (double x = area.min().x() + cell / 2; x < area.max().x(); x += cell) {
                const octomap::OcTreeKey key = map_.coordToKey(x, y, -cell / 2);
                map_.setNodeValue(key, 1.F, true)->faces[5] = {grey(), 1.F};
                change.texture.push_back(brickOf(key));
            }
        }
        map_.updateInnerOccupancy();
        change.normalize();
        change.anyTexture = change.texture;
        return change;
    }

    std::shared_ptr<const ViewSource> freshViews() const {
        return std::make_shared<VoxelRenderer>(map_, UnknownPolicy::free);
    }

    DistanceMap freshClearance() const {
        return {map_, bounds_, {.maxDistance = 1., .unknown = UnknownPolicy::free}};
    }

    /// Reads the clearance of the map as it is when it is asked.
    Clearance clearance() const {
        return [this](const Vector3d& p) { return clearance_.clearance(p); };
    }

  private:
    static Eigen::Array3i brickOf(const octomap::OcTreeKey& key) {
        const Eigen::Array3i cell(key[0], key[1], key[2]);
        return (cell - kKeyOfZero).unaryExpr([](int i) { return i >> 2; });
    }

    Eigen::AlignedBox3d bounds_;
    TexturedOcTree map_{0.2};
    DistanceMap clearance_;
};

enum class Scene { flat, withHeading, overTexture };

const Eigen::AlignedBox2d kFloor(Eigen::Vector2d(-2., -2.), Eigen::Vector2d(10., 10.));

Problem problemIn(Scene scene) {
    Problem problem;
    problem.start = {1., 1., 2.};
    problem.goal = {6.6, 7., 2.};
    problem.bounds = box({0, 0, 2}, {8, 8, 2});
    if (scene == Scene::withHeading) {
        problem.kind = StateKind::positionYaw;
        problem.bounds = box({0, 0, 1}, {8, 8, 3});
    }
    return problem;
}

/// A robot that flies through a world which changes around it.
class ChangingFlight {
  public:
    ChangingFlight(const std::string& name, Scene scene, std::uint32_t seed)
        : problem_(problemIn(scene)), world_(problem_.bounds), random_(seed) {
        if (name == "rrt_star") problem_.belief.alpha = 1.;
        problem_.growth.seed = seed;
        problem_.clearance = world_.clearance();
        if (scene == Scene::overTexture) {
            world_.paintFloor(kFloor, [] { return 0.5F; });
            isOverTexture_ = true;
        }
        field_ = makeField();
        planner_ = problem_.planner(name, 5, makeModel(field_));
        planner_->params().setParam("max_vertices", name == "rrbt" ? "120" : "250");
        if (name == "belief_rrt_star") planner_->params().setParam("shortcut", "200");
        position_ = problem_.start;
    }

    BeliefPlanner& planner() { return *planner_; }
    bool hasPath() const { return planner_->getProblemDefinition()->hasSolution(); }

    void plan() {
        const std::size_t last = planner_->iterations() + 800;
        planner_->solve(
            ob::PlannerTerminationCondition([&] { return planner_->iterations() >= last; }));
    }

    /// A wall appears, or one that has appeared vanishes, or the floor looks different.
    void changeTheMap() {
        if (isOverTexture_ && random(0., 1.) < 0.6) {
            const Eigen::Vector2d low(random(0., 6.), random(0., 6.));
            const Eigen::AlignedBox2d area(low, low + Eigen::Vector2d(2., 2.));
            paint(area, random(0., 1.) < 0.3 ? 0. : 0.8);
            return;
        }
        if (walls_.size() > 5 || (!walls_.empty() && random(0., 1.) < 0.4)) {
            const auto i = static_cast<std::ptrdiff_t>(random(0., 0.999) * walls_.size());
            const Eigen::AlignedBox3d wall = walls_[i];
            walls_.erase(walls_.begin() + i);
            follow(world_.fill(wall, false));
            return;
        }
        const int axis = random(0., 1.) < 0.5 ? 0 : 1;
        Vector3d low(random(0., 6.), random(0., 6.), 0.);
        Vector3d size(0.4, 0.4, 4.);
        size[axis] = random(2., 6.);
        const Eigen::AlignedBox3d wall(low, low + size);
        if (wall.exteriorDistance(position_) < 0.6) return;
        walls_.push_back(wall);
        follow(world_.fill(wall, true));
    }

    /// Gives a part of the floor random grey values.
    void paint(const Eigen::AlignedBox2d& area, double contrast) {
        follow(world_.paintFloor(
            area, [&] { return static_cast<float>(0.5 + contrast * random(-0.5, 0.5)); }));
    }

    /// Along the path, and somewhat off it.
    void move() {
        Vector3d target = position_ + Vector3d(random(-1., 1.), random(-1., 1.), 0.);
        if (hasPath()) {
            const auto& states = path().getStates();
            const Vector3d next =
                problem_.space().position(states[std::min<std::size_t>(1, states.size() - 1)]);
            target = position_ + random(0.2, 1.) * (next - position_);
            if (random(0., 1.) < 0.5) target += Vector3d(random(-.1, .1), random(-.1, .1), 0.);
        }
        const auto si = planner_->getSpaceInformation();
        ob::ScopedState<> state(si);
        problem_.space().setState(state.get(), target, 0.);
        if (!si->isValid(state.get())) return;
        position_ = target;
        root_ = Belief{random(0.5, 2.) * problem_.belief.initialCovariance, 0.};
        planner_->moveRoot(state.get(), *root_);
    }

    /// Cost of the best path that a new planner with as many vertices finds for the problem as it
    /// is now.
    double costFromScratch(const std::string& name, unsigned shortcut) {
        Problem now = problem_;
        now.start = position_;
        const auto planner = now.planner(name, 5, makeModel(makeField()));
        planner->params().setParam("max_vertices", "250");
        planner->params().setParam("shortcut", std::to_string(shortcut));
        ob::ScopedState<> state(planner->getSpaceInformation());
        now.space().setState(state.get(), position_, 0.);
        if (root_) planner->moveRoot(state.get(), *root_);
        planner->solve(
            ob::PlannerTerminationCondition([&] { return planner->iterations() >= 5000; }));
        return planner->bestCost();
    }

    /// The solution is free in the map as it is now and costs what its beliefs say; so do all
    /// beliefs of the tree.
    void check() {
        const Audit audit = auditTree(*planner_);
        EXPECT_LT(audit.maxCostError, 1e-9);
        EXPECT_LT(audit.maxCovarianceError, 1e-9);
        EXPECT_EQ(hasPath(), planner_->bestCost() < kInfinity);
        if (!hasPath()) return;
        const DistanceMap clearance = world_.freshClearance();
        Problem now = problem_;
        now.clearance = [&](const Vector3d& p) { return clearance.clearance(p); };
        const auto si = now.spaceInformation();
        const auto& states = path().getStates();
        for (std::size_t i = 1; i < states.size(); ++i) {
            EXPECT_TRUE(si->checkMotion(states[i - 1], states[i])) << "motion " << i;
        }
        EXPECT_TRUE(problem_.space().position(states.front()).isApprox(position_));
        EXPECT_TRUE(planner_->getProblemDefinition()->getGoal()->isSatisfied(states.back()));
        EXPECT_NEAR(planner_->bestCost(), replayedCost(states), 1e-9);
    }

  private:
    void follow(const MapChange& change) {
        if (isOverTexture_) field_->update(world_.freshViews(), change);
        planner_->mapChanged(change);
    }
    std::shared_ptr<InformationField> makeField() const {
        const InformationField::Options options{.positionPitch = 0.25};
        if (!isOverTexture_) {
            return std::make_shared<InformationField>(problem_.information, problem_.mount,
                                                      options);
        }
        const Camera camera = makeCamera(24, 16, 1.2);
        return std::make_shared<InformationField>(
            world_.freshViews(), camera, photometricModel(camera, {}), problem_.mount, options);
    }
    std::shared_ptr<BeliefModel> makeModel(std::shared_ptr<InformationField> field) const {
        return std::make_shared<BeliefModel>(problem_.space(), std::move(field), problem_.belief);
    }
    double random(double low, double high) {
        return low + (high - low) * std::generate_canonical<double, 32>(random_);
    }
    ompl::geometric::PathGeometric& path() const {
        return *planner_->getProblemDefinition()
                    ->getSolutionPath()
                    ->as<ompl::geometric::PathGeometric>();
    }
    /// With an information field of its own.
    double replayedCost(const std::vector<ob::State*>& states) const {
        const auto model = makeModel(makeField());
        std::vector<BeliefPoint> points = model->evaluate({states.front()});
        if (root_) {
            points.front().covariance = model->cameraCovariance(states.front(), *root_);
            points.front().trace =
                weightedTrace(root_->covariance, problem_.belief.characteristicLength);
        }
        for (std::size_t i = 1; i < states.size(); ++i) {
            model->evaluateMotion(states[i - 1], states[i], points);
        }
        return points.back().cost;
    }

    Problem problem_;
    ChangingWorld world_;
    bool isOverTexture_ = false;
    std::shared_ptr<InformationField> field_;
    std::mt19937 random_;
    std::shared_ptr<BeliefPlanner> planner_;
    std::vector<Eigen::AlignedBox3d> walls_;
    Vector3d position_;
    std::optional<Belief> root_;  // once it was moved
};

class ChangingMap : public testing::TestWithParam<std::tuple<std::string, Scene>> {};
std::string nameOf(const testing::TestParamInfo<std::tuple<std::string, Scene>>& test) {
    const std::array scenes{"_flat", "_with_heading", "_over_texture"};
    return std::get<0>(test.param) + scenes[static_cast<std::size_t>(std::get<1>(test.param))];
}

INSTANTIATE_TEST_SUITE_P(
    Planners, ChangingMap,
    testing::Combine(testing::Values("rrt_star", "pa_rrt_star", "rrbt", "belief_rrt_star"),
                     testing::Values(Scene::flat, Scene::withHeading, Scene::overTexture)),
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

/// By how much the cost of a plan that follows random changes exceeds that of plans from scratch,
/// relative; one value per update, in three scenes, sorted.
std::vector<double> excessOverScratch(std::uint32_t firstSeed, std::uint32_t lastSeed) {
    constexpr unsigned kShortcut = 1000;
    constexpr int kUpdates = 6;
    const std::string name = "belief_rrt_star";
    std::vector<double> excess;
    for (const Scene scene : {Scene::flat, Scene::withHeading, Scene::overTexture}) {
        for (std::uint32_t seed = firstSeed; seed <= lastSeed; ++seed) {
            ChangingFlight flight(name, scene, seed);
            flight.planner().params().setParam("shortcut", std::to_string(kShortcut));
            flight.plan();
            for (int step = 0; step < kUpdates && !testing::Test::HasFailure(); ++step) {
                flight.changeTheMap();
                if (step % 2 == 1) flight.move();
                flight.plan();
                flight.check();
                const double scratch = flight.costFromScratch(name, kShortcut);
                if (!flight.hasPath() || scratch == kInfinity) continue;
                excess.push_back(flight.planner().bestCost() / scratch - 1.);
            }
        }
    }
    std::sort(excess.begin(), excess.end());
    return excess;
}

void expectLittle(const std::vector<double>& excess) {
    const auto count = static_cast<double>(excess.size());
    const double mean = std::accumulate(excess.begin(), excess.end(), 0.) / count;
    const double median = excess[excess.size() / 2];
    std::printf(
        "%.0f updates; J above that from scratch: mean %.2f %%, median %.2f %%, 90 %% %.2f %%, "
        "most %.2f %%\n",
        count, 100. * mean, 100. * median, 100. * excess[excess.size() * 9 / 10],
        100. * excess.back());
    EXPECT_LT(mean, 0.02);
    EXPECT_LT(median, 0.02);
}

TEST(RepairedPlan, CostsHardlyMoreThanOneFromScratch) {
    const auto excess = excessOverScratch(11, 12);
    ASSERT_GT(excess.size(), 25U);
    expectLittle(excess);
}

/// Takes minutes; run it with --gtest_also_run_disabled_tests.
TEST(RepairedPlan, DISABLED_CostsHardlyMoreInManySequences) {
    const auto excess = excessOverScratch(1, 10);
    ASSERT_GT(excess.size(), 140U);
    expectLittle(excess);
}

/// A planner above a changing world of walls.
struct PlannerBetweenWalls {
    explicit PlannerBetweenWalls(const std::string& name, std::size_t vertices = 200)
        : problem(problemIn(Scene::flat)), world(problem.bounds) {
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

TEST(ChangedTree, VerticesWhoseInformationChangedAreRewired) {
    ChangingFlight flight("pa_rrt_star", Scene::overTexture, 4);
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

TEST(ChangedBeliefRRTstar, RendersOnlyTheViewsThatItsSearchAsksFor) {
    ChangingFlight flight("belief_rrt_star", Scene::overTexture, 5);
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
