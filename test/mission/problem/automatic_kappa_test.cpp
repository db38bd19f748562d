// SPDX-License-Identifier: BSD-3-Clause
// What alpha and kappa do: the kappa that is chosen, and whether a path has an advantage.
#include <gtest/gtest.h>

#include "problem/advantage.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {
namespace {

/// On the shortest path both terms weigh the same: its cost is its length, and alpha the share.
TEST(AutomaticKappa, IsThatOfTheShortestPath) {
    for (const char* rule : {"integral", "per_vertex"}) {
        const Config config =
            loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml",
                       {"planner.vertices=150", "planner.view_pitch=0.5", "planner.kappa=auto",
                        "planner.alpha=0.3", std::string("planner.cost=") + rule});
        const World world(config);
        PlanningProblem problem(config, world);
        const EvaluatedPath shortest = problem.solve("rrt_star").path.value();
        EXPECT_NEAR(shortest.lengthShare, 0.3, 1e-9) << rule;
        EXPECT_NEAR(shortest.cost, shortest.points.back().distance, 1e-9) << rule;
        const EvaluatedPath ours = problem.solve("belief_rrt_star").path.value();
        EXPECT_LT(ours.cost, 0.9 * shortest.cost) << rule;
        EXPECT_NEAR(ours.lengthShare * ours.cost, 0.3 * ours.points.back().distance, 1e-9);
        // Problems of other seeds share it.
        Config other = withKappa(config, world);
        EXPECT_EQ(other.belief.kappa, problem.kappa());
        other.seed = 7;
        EXPECT_EQ(PlanningProblem(other, world).kappa(), problem.kappa());
    }
}

TEST(AutomaticKappa, ShowsTheGrowthOfItsTreeOnce) {
    const Config config =
        loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml",
                   {"planner.vertices=150", "planner.view_pitch=0.5", "planner.kappa=auto"});
    const World world(config);
    PlanningProblem problem(config, world);
    std::vector<std::size_t> shown;
    const auto show = [&](const PlanProgress& progress) { shown.push_back(progress.vertices); };
    problem.kappa(kNotInterrupted, show);
    ASSERT_GE(shown.size(), 3U);
    EXPECT_EQ(shown.back(), 150U);
    const std::size_t calls = shown.size();
    problem.kappa(kNotInterrupted, show);
    EXPECT_EQ(shown.size(), calls);
}

TEST(AutomaticKappa, IsAskedForOnlyWhereItIsNotGiven) {
    const Config config =
        loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml");  // the paper's 2.5
    const World world(config);
    EXPECT_EQ(PlanningProblem(config, world).kappa(), 2.5);
    EXPECT_EQ(withKappa(config, world).belief.kappa, 2.5);
    EXPECT_TRUE(isAutomatic(defaultBelief().kappa));
}

TEST(AutomaticKappa, WithoutAPathTheStraightLineTakesItsPlace) {
    Config config =
        loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", {"planner.view_pitch=0.5"});
    config.belief.kappa = kAutomaticKappa;
    const World world(config);
    config.vertices = 2;
    config.growth.range = 0.1;
    PlanningProblem problem(config, world);
    const EvaluatedPath line = problem.evaluate("line", {config.start, config.goal});
    EXPECT_NEAR(problem.kappa(), 1. / line.meanTrace, 1e-9 / line.meanTrace);
    config.belief.initialCovariance.setZero();
    config.belief.motionNoise.setZero();
    EXPECT_EQ(PlanningProblem(config, world).kappa(), 0.);
}

EvaluatedPath pathOf(double cost, double lengthShare, double length, double meanTrace) {
    EvaluatedPath path;
    path.cost = cost;
    path.lengthShare = lengthShare;
    path.length = length;
    path.meanTrace = meanTrace;
    path.points.emplace_back().information = Matrix6::Identity();
    return path;
}

TEST(Advantage, IsDeniedWithItsReason) {
    const EvaluatedPath shortest = pathOf(10., 0.5, 10., 1.);
    EXPECT_EQ(noAdvantage(pathOf(9.8, 0.56, 11., 0.8), shortest, 0.5), "");
    const auto reason = [&](const EvaluatedPath& path, const EvaluatedPath& other, double alpha) {
        const std::string text = noAdvantage(path, other, alpha);
        EXPECT_TRUE(text.starts_with("no advantage over the shortest path: ")) << text;
        return text;
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(has(reason(shortest, shortest, 1.), "alpha is 1"));
    EXPECT_TRUE(has(reason(shortest, shortest, 0.5), "as certain"));
    EXPECT_TRUE(has(reason(pathOf(10., 0.9, 12., 0.3), shortest, 0.5), "costs in length"));
    EXPECT_TRUE(has(reason(pathOf(11., 0.9, 12., 0.9), shortest, 0.5), "more vertices"));
    EXPECT_TRUE(has(reason(pathOf(9., 0.44, 8., 1.), shortest, 0.5), "not because it is more"));
    EXPECT_TRUE(has(reason(pathOf(10., 1., 10., 1.), pathOf(10., 0.998, 10., 1.), 0.5),
                    "only 0.2 % of the cost"));
    EvaluatedPath blind = shortest;
    blind.points.front().information.setZero();
    EXPECT_TRUE(has(reason(blind, blind, 0.5), "no view along either path"));
    EXPECT_EQ(costShares(pathOf(1., 0.25, 1., 1.)), "25 % length, 75 % uncertainty");
    EXPECT_EQ(costShares(pathOf(1., 0.998, 1., 1.)), "99.80 % length, 0.20 % uncertainty");
}

}  // namespace
}  // namespace photonav
