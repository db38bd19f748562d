// SPDX-License-Identifier: BSD-3-Clause
// Views of planners that are run by programs of their own, while a flag is watched.
#include <gtest/gtest.h>

#include "io/interrupted.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {
namespace {

TEST(InterruptionScope, EndsLargeViewsWhileItIsThere) {
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml",
                                     {"camera.width=2000", "camera.height=1100"});
    const World world(config);
    PlanningProblem problem(config, world);
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() << 6., 3., 2.;
    {
        const std::atomic<bool> interrupted{true};
        const InterruptionScope outer = problem.interruptedBy(interrupted);
        {
            const InterruptionScope inner = problem.interruptedBy(kNotInterrupted);
            EXPECT_GT(problem.informationAt(T_w_b).trace(), 0.);
        }
        T_w_b.translation().x() += 1.;
        EXPECT_THROW(problem.informationAt(T_w_b), Interrupted);
    }
    EXPECT_GT(problem.informationAt(T_w_b).trace(), 0.);
}

/// The views along a path of rrt_star are rendered by nobody before.
TEST(Interruption, EndsTheEvaluationOfAPath) {
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml",
                                     {"camera.width=2000", "camera.height=1100",
                                      "planner.vertices=200", "planner.view_at_start=false"});
    const World world(config);
    PlanningProblem problem(config, world);
    std::atomic<bool> interrupted = false;
    const PlanOutcome outcome = problem.solve(
        "rrt_star", interrupted,
        [&](const PlanProgress& progress) { interrupted = progress.vertices >= config.vertices; });
    EXPECT_TRUE(std::isfinite(outcome.progress.back().cost));
    EXPECT_FALSE(outcome.path);
}

}  // namespace
}  // namespace photonav
