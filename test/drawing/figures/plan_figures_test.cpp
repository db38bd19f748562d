// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "figures/problem_view.hpp"
#include "figures/trace.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {
namespace {

DrawnPath withoutBefore(DrawnPath path) {
    for (PathPoint& point : path.points) point.traceBefore.reset();
    return path;
}

/// Turns count in the mean as lengths that are not drawn: here there are none.
TEST(TraceFigure, ItsCurveHasTheMeanThatIsStated) {
    Config config = test::flightThroughRoom();
    config.space = StateKind::position;
    const World world(test::roomToExplore(), config);
    PlanningProblem problem(config, world);
    const EvaluatedPath evaluated = problem.evaluate(
        "given", {{config.start.position, {}}, {{4., 2., 1.2}, {}}}, kNotInterrupted);
    const DrawnPath path = drawnPath(evaluated, config.camera.T_b_c());

    double sum = 0.;
    for (std::size_t i = 1; i < path.points.size(); ++i) {
        const PathPoint &last = path.points[i - 1], &next = path.points[i];
        sum += 0.5 * (next.distance - last.distance) * (last.trace + next.traceBefore.value());
    }
    EXPECT_NEAR(sum / path.points.back().distance, evaluated.meanTrace, 1e-3 * evaluated.meanTrace);
    EXPECT_NE(traceFigure("", {path}, true).svg(),
              traceFigure("", {withoutBefore(path)}, true).svg());
}

}  // namespace
}  // namespace photonav
