// SPDX-License-Identifier: BSD-3-Clause
#include "planners/cost_to_go.hpp"

#include <gtest/gtest.h>

#include <random>

#include "planning/fixture.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav::test {
namespace {

/// A grid of vertices half a metre apart, each joined to its eight neighbours; goal at (3, 9).
class Grid {
  public:
    static constexpr int kSide = 20;

    explicit Grid(const Problem& problem)
        : si_(problem.spaceInformation()), model(problem.model()) {
        for (int i = 0; i < kSide; ++i) {
            for (int j = 0; j < kSide; ++j) {
                Vertex& vertex = vertices.emplace_back();
                vertex.state = si_->allocState();
                vertex.index = static_cast<std::uint32_t>(vertices.size() - 1);
                problem.space().setState(vertex.state, {0.5 * i, 0.5 * j, 2.}, 0.);
            }
        }
        for (int i = 0; i < kSide; ++i) {
            for (int j = 0; j < kSide; ++j) {
                join(i, j, i + 1, j - 1);
                join(i, j, i + 1, j);
                join(i, j, i + 1, j + 1);
                join(i, j, i, j + 1);
            }
        }
        toGo.update(roadmap, vertices, {&at(6, 18)}, *model);
    }
    ~Grid() {
        for (Vertex& vertex : vertices) si_->freeState(vertex.state);
    }
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    Vertex& at(int i, int j) { return vertices[i * kSide + j]; }

    double bound(Vertex& vertex, const Matrix6& covariance) {
        return toGo.from(vertex, toGo.variances(covariance));
    }

    std::deque<Vertex> vertices;
    Roadmap roadmap;
    CostToGo toGo;

  private:
    ob::SpaceInformationPtr si_;

  public:
    std::shared_ptr<BeliefModel> model;

  private:
    void join(int i, int j, int k, int l) {
        if (k >= kSide || l >= kSide || l < 0) return;
        roadmap.add(&at(i, j), &at(k, l), model->motion(at(i, j).state, at(k, l).state));
    }
};

/// Flies at random, but rather toward `toX` and then the goal, and compares what that cost with the
/// bound at every vertex on the way.
void flyAndCompare(Grid& grid, double toX, std::mt19937& random) {
    std::uniform_int_distribution<int> pick(0, Grid::kSide - 1);
    Vertex* vertex = &grid.at(pick(random), pick(random));
    const Vertex* goal = &grid.at(6, 18);
    Belief belief = grid.model->root(vertex->state);
    std::vector<std::pair<double, double>> sofarAndBound;
    bool turned = false;
    for (int step = 0; vertex != goal && step < 3000; ++step) {
        sofarAndBound.emplace_back(belief.cost, grid.bound(*vertex, belief.covariance));
        Roadmap::Edge* best = nullptr;
        double least = 1e9;
        for (Roadmap::Edge* edge : grid.roadmap.of(vertex)) {
            const auto p = grid.model->space().position(edge->otherEnd(vertex)->state);
            const double way = turned ? (p - grid.model->space().position(goal->state)).norm()
                                      : std::abs(p.x() - toX);
            const double noisy = way + 0.3 * std::generate_canonical<double, 32>(random);
            if (noisy < least) {
                least = noisy;
                best = edge;
            }
        }
        belief = grid.model->propagate(belief, best->motion, best->to == vertex);
        vertex = best->otherEnd(vertex);
        turned = turned || std::abs(grid.model->space().position(vertex->state).x() - toX) < 0.1;
    }
    ASSERT_EQ(vertex, goal);
    for (const auto& [sofar, bound] : sofarAndBound) EXPECT_LE(sofar + bound, belief.cost + 1e-9);
}

TEST(CostToGo, NoFlightCostsLess) {
    std::mt19937 random(1);
    for (const double alpha : {0., 0.05, 0.5}) {
        Problem problem;
        problem.belief.alpha = alpha;
        Grid grid(problem);
        for (const double toX : {0., 3., 4.5, 6.5, 8.}) {
            for (int i = 0; i < 8; ++i) flyAndCompare(grid, toX, random);
        }
    }
}

TEST(CostToGo, ChargesUncertaintyUntilTheFirstInformativeView) {
    Problem problem;
    Grid grid(problem);
    Vertex& start = grid.at(6, 2);  // 1 m from the stripes, 3 m from the texture
    const Belief root = grid.model->root(start.state);
    const double byLength = problem.belief.alpha * 8.;
    EXPECT_GT(grid.bound(start, root.covariance), 2. * byLength);
    // The noise of steps of 0.25 m, which are charged over half their length.
    const double noise = 0.95 * problem.belief.kappa * 0.125 * grid.model->noiseTrace() * 8.;
    EXPECT_NEAR(grid.bound(start, 1e-9 * root.covariance), byLength + noise, 1e-3);
    // Nothing to see anywhere: the whole way at the initial uncertainty of the position.
    problem.information = [](const Pose&) { return Matrix6::Zero().eval(); };
    Grid blind(problem);
    const double charge = 0.95 * problem.belief.kappa * 0.05 * 8.;
    EXPECT_NEAR(blind.bound(blind.at(6, 2), root.covariance), byLength + noise + charge,
                0.02 * charge);
}

/// Images are of single precision: over stripes, rounding alone gives 3e-11 of the information
/// about the axis that they show for the axis that they do not show.
TEST(CostToGo, RoundingOfImagesObservesNoAxis) {
    const auto boundWith = [](double share) {
        Problem problem;
        problem.information = [share](const Pose& T_c_w) {
            Matrix6 information = Matrix6::Zero();  // axes of the world
            information(0, 0) = 1e8;
            information(1, 1) = share * 1e8;
            return inRotatedAxes(information, T_c_w.linear());
        };
        Grid grid(problem);
        return grid.bound(grid.at(6, 2), problem.belief.initialCovariance);
    };
    const double unobserved = boundWith(0.);
    EXPECT_DOUBLE_EQ(boundWith(3e-11), unobserved);
    EXPECT_LT(boundWith(1e-5), 0.9 * unobserved);
}

TEST(CostToGo, NeedsViewsOnlyWhereTheStartIsUncertain) {
    const Problem problem;
    Grid grid(problem);
    Vertex& start = grid.at(6, 2);
    InformationField& field = grid.model->field();
    const Matrix6 covariance = problem.belief.initialCovariance;
    const auto boundFrom = [&](const Matrix6& atStart, bool wellObserved = true) {
        field.clear();
        grid.toGo.update(grid.roadmap, grid.vertices, {&grid.at(6, 18)}, *grid.model,
                         {{&start, atStart}}, wellObserved, ob::plannerNonTerminatingCondition());
        return grid.bound(start, atStart);
    };
    const double uncertain = boundFrom(covariance);
    EXPECT_GT(field.views(), 100U);
    const double certain = boundFrom(1e-3 * covariance);
    EXPECT_EQ(field.views(), 0U);
    EXPECT_LT(certain, uncertain);
    EXPECT_GT(certain, problem.belief.alpha * 8.);
    boundFrom(1e-3 * covariance, false);
    EXPECT_GT(field.views(), 100U);
}

/// What it has rendered when it is stopped is not rendered again.
TEST(CostToGo, RendersNoMoreViewsOnceItIsStopped) {
    const Problem problem;
    Grid grid(problem);
    InformationField& field = grid.model->field();
    const auto updateUntil = [&](std::size_t views) {
        return grid.toGo.update(
            grid.roadmap, grid.vertices, {&grid.at(6, 18)}, *grid.model,
            {{&grid.at(6, 2), problem.belief.initialCovariance}}, false,
            ob::PlannerTerminationCondition([&, views] { return field.views() >= views; }));
    };
    field.clear();
    EXPECT_FALSE(updateUntil(7));
    EXPECT_EQ(field.views(), 7U);
    EXPECT_TRUE(updateUntil(100000));
    const std::size_t all = field.views();
    EXPECT_GT(all, 100U);
    field.clear();
    EXPECT_TRUE(updateUntil(100000));
    EXPECT_EQ(field.views(), all);
}

TEST(CostToGo, AssumesThatStaleViewsObserveEverything) {
    // Over a map without texture nothing is observed; once it has changed, everything may be.
    TexturedOcTree map(0.2);
    map.setNodeValue(map.coordToKey(4., 4., -0.1), 1.F);
    const auto views = std::make_shared<VoxelRenderer>(map, UnknownPolicy::free);
    const Camera camera = makeCamera(24, 16, 1.2);
    Problem problem;
    Grid grid(problem);
    grid.model = std::make_shared<BeliefModel>(
        problem.space(),
        std::make_shared<InformationField>(views, camera, photometricModel(camera, {}),
                                           problem.mount, InformationField::Options{}),
        problem.belief);
    const auto bound = [&] {
        grid.toGo.update(grid.roadmap, grid.vertices, {&grid.at(6, 18)}, *grid.model);
        return grid.bound(grid.at(6, 2), problem.belief.initialCovariance);
    };
    const double blind = bound();
    const std::size_t rendered = grid.model->field().views();
    MapChange change{.resolution = 0.2};
    for (int x = -5; x < 20; ++x) {
        for (int y = -5; y < 20; ++y) change.texture.emplace_back(x, y, -1);
    }
    change.normalize();
    grid.model->field().update(views, change);
    ASSERT_EQ(grid.model->field().stale(), grid.model->field().size());
    EXPECT_LT(bound(), 0.8 * blind);
    EXPECT_EQ(grid.model->field().views(), rendered);
}

TEST(CostToGo, IsInfiniteWhereNoGoalIsReached) {
    const Problem problem;
    Grid grid(problem);
    for (Vertex& vertex : grid.vertices) {
        for (Roadmap::Edge* edge : grid.roadmap.of(&vertex)) {
            const auto x = [&](const Vertex* v) {
                return grid.model->space().position(v->state).x();
            };
            if ((x(edge->from) < 5.) != (x(edge->to) < 5.)) edge->isFree = false;
        }
    }
    grid.toGo.update(grid.roadmap, grid.vertices, {&grid.at(6, 18)}, *grid.model);
    const Matrix6 covariance = problem.belief.initialCovariance;
    EXPECT_TRUE(std::isinf(grid.bound(grid.at(15, 3), covariance)));
    EXPECT_TRUE(std::isfinite(grid.bound(grid.at(2, 3), covariance)));
}

}  // namespace
}  // namespace photonav::test
