// SPDX-License-Identifier: BSD-3-Clause
// Random sequences of walls that appear and vanish, of textures that change, and of moves of the
// robot.
#include <gtest/gtest.h>
#include <ompl/geometric/PathGeometric.h>

#include <numeric>
#include <random>

#include "planning/planners/changing_world.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

/// A robot that flies through a world which changes around it.
class ChangingFlight {
  public:
    ChangingFlight(const std::string& name, SceneKind scene, std::uint32_t seed)
        : problem_(problemIn(scene)), world_(problem_.bounds), random_(seed) {
        if (name == "rrt_star") problem_.belief.alpha = 1.;
        problem_.growth.seed = seed;
        problem_.clearance = world_.clearance();
        if (scene == SceneKind::overTexture) {
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

    /// A wall appears around a place, or vanishes.
    void wallAround(const Vector3d& p_w, bool isThere) {
        const Vector3d half(0.3, 0.3, 4.);
        follow(world_.fill({p_w - half, p_w + half}, isThere));
    }
    const Vector3d& position() const { return position_; }
    const Vector3d& goal() const { return problem_.goal; }

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
        return model->evaluate({states.begin(), states.end()}, root_).back().cost;
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

/// By how much the cost of a plan that follows random changes exceeds that of plans from scratch,
/// relative; one value per update, in three scenes, sorted.
std::vector<double> excessOverScratch(std::uint32_t firstSeed, std::uint32_t lastSeed) {
    constexpr unsigned kShortcut = 1000;
    constexpr int kUpdates = 6;
    const std::string name = "belief_rrt_star";
    std::vector<double> excess;
    for (const SceneKind scene :
         {SceneKind::flat, SceneKind::withHeading, SceneKind::overTexture}) {
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
