// SPDX-License-Identifier: BSD-3-Clause
// The same way, three ways to look: heading fixed, along the motion, and planned. A corridor has
// texture on one side only.
#include <ompl/geometric/PathGeometric.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "exercises.hpp"
#include "figures/images.hpp"
#include "planners/path_headings.hpp"
#include "plot/figure.hpp"
#include "problem/planning_problem.hpp"
#include "scene/scene.hpp"

using namespace photonav;

namespace {

/// 10 m long and 3 m wide; only the wall on the left of the way shows pictures.
Scene corridor() {
    Scene scene;
    const auto pictures = addTexture(scene, valueNoise({.size = {10., 2.5}, .seed = 1}));
    const auto pale = addTexture(
        scene, valueNoise({.size = {10., 3.}, .amplitudes = {0.004, 0.003, 0.002}, .seed = 2}));
    addBox(scene, {0., 0., 0.}, {10., 3., 2.5}, pale, BoxInside::hollow);
    addPlane(scene, {0., 2.99, 0.}, {10., 0., 0.}, {0., 0., 2.5}, pictures);
    return scene;
}

Config wayThrough() {
    Config config;
    config.bounds = {Eigen::Vector3d(0.4, 0.4, 1.), Eigen::Vector3d(9.6, 2.6, 1.4)};
    config.start.position = {1., 1.2, 1.2};
    config.start.yaw = 0.;
    config.goal.position = {9., 1.2, 1.2};
    config.space = StateKind::positionYaw;
    config.camera.mount = "front45";
    config.photometric = {.sigma = 0.02, .scale = 0.08};
    config.belief.initialCovariance.diagonal() << 1e-4, 1e-4, 1e-4, 1e-5, 1e-5, 1e-4;
    config.belief.motionNoise.diagonal() << 1e-3, 1e-3, 1e-3, 2e-5, 2e-5, 5e-4;  // per metre
    config.belief.alpha = 0.1;
    config.belief.kappa = 1000.;
    config.vertices = 400;
    config.field.positionPitch = 0.25;
    config.field.rotationPitch = 0.2;
    return config;
}

/// An arrow of 40 cm every 80 cm or so: where the robot faces.
void drawHeadings(Plot& plot, const EvaluatedPath& path, const Color& color,
                  const std::string& name) {
    Plot::Points arrows;
    double next = 0.;
    for (const BeliefPoint& point : path.points) {
        if (point.length < next) continue;
        next = point.length + 0.8;
        const Eigen::Vector2d p = point.T_w_b.translation().head<2>();
        arrows.push_back(p);
        arrows.emplace_back(p + 0.4 * point.T_w_b.linear().col(0).head<2>().normalized());
    }
    plot.curve(path.fromAbove(), {.color = color, .width = 2., .name = name, .halo = 1.});
    plot.segments(arrows, {.color = color, .width = 4.});
}

std::vector<Exercise> exercises(PlanningProblem& problem) {
    const auto meanTrace = [&](double yaw) {  // [m^2], straight on
        Place start = problem.config().start, goal = problem.config().goal;
        start.yaw = goal.yaw = yaw;
        return problem.evaluate("straight", {start, goal}).meanTrace;
    };
    return {{[=] { return meanTrace(std::numbers::pi / 2.); }, 0.05},
            {[=] { return meanTrace(-std::numbers::pi / 2.); }, 0.05}};
}

}  // namespace

int main(int argc, char** argv) {
    const Config config = wayThrough();
    const World world(corridor(), config);
    PlanningProblem problem(config, world);
    if (const auto code = checkAnswers(argc, argv, exercises(problem))) return *code;
    const Eigen::AlignedBox2d area(Eigen::Vector2d(0., 0.), Eigen::Vector2d(10., 3.));
    Plot view = Plot::map(area, 800.);
    view.picture(greyPicture(world.pictureFromAbove(area, 2., 0.05)), area, true);
    Plot trace;
    trace.width = 800.;
    trace.x = {.min = 0., .label = "length of the path [m]"};
    trace.y = {.log = true, .label = "trace of the belief [m²]"};

    //! [planned]
    const auto planner = problem.makePlanner("belief_rrt_star");
    planner->solve(ompl::base::PlannerTerminationCondition([] { return false; }));
    const auto solution = planner->getProblemDefinition()->getSolutionPath();
    auto& planned = *solution->as<ompl::geometric::PathGeometric>();
    //! [planned]

    std::puts("headings   length [m]  mean trace [m^2]  goal trace [m^2]");
    const auto show = [&](const std::string& name, const EvaluatedPath& path, const Color& color) {
        std::printf("%-9s %11.2f  %16.2e  %16.2e\n", name.c_str(), path.length, path.meanTrace,
                    path.goalTrace);
        drawHeadings(view, path, color, name);
        Plot::Points curve;
        for (const BeliefPoint& p : path.points) curve.emplace_back(p.length, p.trace);
        trace.curve(curve, {.color = color, .name = name});
    };
    show("planned", problem.evaluate("planned", planned), plannerColor("belief_rrt_star"));
    //! [rivals]
    const std::vector<const ompl::base::State*> states(planned.getStates().begin(),
                                                       planned.getStates().end());
    for (const auto& [name, headings] :
         {std::pair{"fixed", Headings::fixed}, {"forward", Headings::forward}}) {
        ompl::geometric::PathGeometric rival(problem.spaceInformation());
        for (const auto& state :
             replaceHeadings(problem.spaceInformation(), problem.space(), states, headings)) {
            rival.append(state.get());
        }
        show(name, problem.evaluate(name, rival), plannerColor(std::string("rrt_star/") + name));
    }
    //! [rivals]
    Figure{"Where to look", {{view}, {trace}}}.save("where_to_look.png");
    std::puts("wrote where_to_look.png");
}
