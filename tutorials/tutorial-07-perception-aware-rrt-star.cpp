// SPDX-License-Identifier: BSD-3-Clause
// Three planners, one question: from start to goal over a floor that is half white, half textured.
// RRT* flies straight over white; the perception-aware ones make a detour to observe texture.
#include <cstdio>

#include "exercises.hpp"
#include "figures/images.hpp"
#include "io/error.hpp"
#include "plot/figure.hpp"
#include "problem/planning_problem.hpp"

using namespace photonav;

namespace {

//! [ellipse]
/// Three standard deviations of the position in x and y. The covariance lives in the camera frame.
Plot::Points ellipseOf(const BeliefPoint& point, const Pose& T_b_c) {
    const Eigen::Matrix3d R_w_c = (point.T_w_b * T_b_c).linear();
    const Eigen::Matrix3d position =
        R_w_c * point.covariance.topLeftCorner<3, 3>() * R_w_c.transpose();
    return ellipse(point.T_w_b.translation().head<2>(), position.topLeftCorner<2, 2>(), 3.);
}
//! [ellipse]

std::vector<Exercise> exercises(const Config& config, const World& world) {
    return {{[&] {
                return PlanningProblem(config, world)
                    .evaluate("straight", {config.start, config.goal})
                    .cost;
            }},
            {[&] {
                return PlanningProblem(config, world, 0.75).solve("belief_rrt_star").path->length;
            }}};
}

}  // namespace

int main(int argc, char** argv) try {
    //! [problem]
    std::vector<std::string> settings{"planner.alpha=0.1", "planner.vertices=600",
                                      "planner.view_pitch=0.25"};
    if (argc > 1 && !asksForCheck(argc, argv))
        settings.push_back(std::string("scene.file=") + argv[1]);
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", settings);
    const World world(config);
    //! [problem]
    if (const auto code = checkAnswers(argc, argv, exercises(config, world))) return *code;
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-2., -1.5), Eigen::Vector2d(10., 12.));
    Plot plot = Plot::map(area, 460.);
    plot.picture(greyPicture(world.pictureFromAbove(area, 2., 1. / 34.)), area, true);

    std::puts("planner          length [m]  mean trace [m^2]  goal trace [m^2]    cost   views");
    for (const std::string name : {"rrt_star", "pa_rrt_star", "belief_rrt_star"}) {
        //! [plan]
        const PlanOutcome outcome = PlanningProblem(config, world).solve(name);
        const EvaluatedPath& path = outcome.path.value();
        std::printf("%-16s %10.2f  %16.4f  %16.4f  %7.3f  %6zu\n", name.c_str(), path.length,
                    path.meanTrace, path.goalTrace, path.cost, outcome.views);
        //! [plan]
        const Color color = plannerColor(name);
        for (std::size_t i = 0; i < path.points.size(); i += 6) {
            plot.curve(ellipseOf(path.points[i], config.camera.T_b_c()),
                       {.color = color, .width = 1.});
        }
        plot.curve(path.fromAbove(), {.color = color, .width = 3., .name = name, .halo = 1.});
    }
    Figure{"Paths with the 3σ ellipses of the position", {{plot}}, Figure::Legend::right}.save(
        "perception_aware_rrt_star.png");
    std::puts("wrote perception_aware_rrt_star.png");
} catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
