// SPDX-License-Identifier: BSD-3-Clause
// Three planners, one question: from start to goal over a floor that is half white, half textured.
// RRT* flies straight over white; the perception-aware ones pay a detour to see where they are.
#include <ompl/base/ScopedState.h>
#include <ompl/geometric/PathGeometric.h>

#include <cstdio>

#include "belief_rrt_star.hpp"
#include "perception_rrt_star.hpp"
#include "plot.hpp"
#include "two_textures.hpp"

using namespace photonav;
namespace ob = ompl::base;

namespace {

constexpr std::size_t kVertices = 600;
constexpr double kAlpha = 0.1;       // 1: the shortest way, 0: the most certain one
constexpr double kViewPitch = 0.25;  // one view stands for its surroundings [m]

struct Contender {
    std::string name;
    cv::Scalar colour;
    int width;  // of its line [pixels]
};

//! [planner]
std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name, const FlightSpace& space,
                                           const std::shared_ptr<InformationField>& field) {
    const auto anywhere = [](const Eigen::Vector3d&) { return 1.; };  // clearance: no obstacles
    const auto si = makeSpaceInformation(space, anywhere, 0.3);
    const double alpha = name == "rrt_star" ? 1. : kAlpha;
    const auto model = std::make_shared<BeliefModel>(space, field, two_textures::beliefs(alpha));
    std::shared_ptr<BeliefPlanner> planner;
    if (name == "belief_rrt_star") {
        planner = std::make_shared<BeliefRRTstar>(si, model);
    } else {
        planner = std::make_shared<PerceptionRRTstar>(si, model);
    }
    ob::ScopedState<> start(si);
    ob::ScopedState<> goal(si);
    space.setState(start.get(), {0., 0., 2.}, 0.);
    space.setState(goal.get(), {2., 9., 2.}, 0.);
    const auto definition = std::make_shared<ob::ProblemDefinition>(si);
    definition->setStartAndGoalStates(start, goal);
    planner->setProblemDefinition(definition);
    planner->setup();
    return planner;
}
//! [planner]

//! [plan]
/// Plans, and lets one judge say what the path is worth, whoever found it.
std::vector<BeliefPoint> plan(BeliefPlanner& planner, BeliefModel& judge) {
    planner.solve(
        ob::PlannerTerminationCondition([&planner] { return planner.vertices() >= kVertices; }));
    const auto path = planner.getProblemDefinition()->getSolutionPath();
    std::vector<const ob::State*> states;
    for (const ob::State* state : path->as<ompl::geometric::PathGeometric>()->getStates()) {
        states.push_back(state);
    }
    return judge.evaluate(states);
}
//! [plan]

double meanTrace(const std::vector<BeliefPoint>& path) {
    double integral = 0.;
    for (std::size_t i = 1; i < path.size(); ++i) {
        integral += 0.5 * (path[i].distance - path[i - 1].distance) *
                    (path[i - 1].trace + path[i].traceBefore);
    }
    return integral / path.back().distance;
}

//! [ellipse]
/// Three standard deviations of the position in x and y. The covariance lives in the camera frame.
Plot::Points ellipse(const BeliefPoint& point, const Pose& T_b_c) {
    const Eigen::Matrix3d R_w_c = (point.T_w_b * T_b_c).linear();
    const Eigen::Matrix3d position =
        R_w_c * point.covariance.topLeftCorner<3, 3>() * R_w_c.transpose();
    const Eigen::Matrix2d root = position.topLeftCorner<2, 2>().llt().matrixL();
    Plot::Points points;
    for (int i = 0; i <= 60; ++i) {
        const double t = i * std::numbers::pi / 30.;
        points.push_back(point.T_w_b.translation().head<2>() +
                         3. * root * Eigen::Vector2d(std::cos(t), std::sin(t)));
    }
    return points;
}
//! [ellipse]

/// The floor behind the plot: seen from so high above that perspective does not matter.
void drawFloor(Plot& plot, const ViewSource& floor) {
    Pose T_w_c = Pose::Identity();  // image right is world x, image down is world -y
    T_w_c.linear() = Eigen::Vector3d(1., -1., -1.).asDiagonal();
    T_w_c.translation() << 4., 5.25, 500.;
    View view;
    floor.render(makeCamera(408, 459, 2. * std::atan(6. / 500.)), T_w_c.inverse(), view);
    plot.picture(view.intensity.bitmap, 459, 408);
}

}  // namespace

int main(int argc, char** argv) {
    const MeshRenderer floor = two_textures::loadFloor(argc, argv);
    const FlightSpace space = two_textures::flightSpace();
    const auto field = two_textures::views(floor, kViewPitch);
    BeliefModel judge(space, field, two_textures::beliefs(kAlpha));
    Plot plot({Eigen::Vector2d(-2., -1.5), Eigen::Vector2d(10., 12.)}, 34.);
    drawFloor(plot, floor);

    std::puts("planner          length [m]  mean trace  goal trace [0.01 m^2]    cost   views");
    const std::vector<Contender> contenders = {{"rrt_star", {200, 60, 40}, 3},
                                               {"pa_rrt_star", {240, 150, 20}, 5},
                                               {"belief_rrt_star", {20, 60, 200}, 2}};
    for (const auto& [name, colour, width] : contenders) {
        const auto planner = makePlanner(name, space, two_textures::views(floor, kViewPitch));
        const std::vector<BeliefPoint> path = plan(*planner, judge);
        std::printf("%-16s %9.2f  %10.2f  %10.2f  %16.3f  %6zu\n", name.c_str(),
                    path.back().distance, 100. * meanTrace(path), 100. * path.back().trace,
                    path.back().cost, planner->model().field().views());
        Plot::Points line;
        for (std::size_t i = 0; i < path.size(); ++i) {
            line.push_back(path[i].T_w_b.translation().head<2>());
            if (i % 6 == 0) plot.curve(ellipse(path[i], field->mount()), colour, 1);
        }
        plot.curve(line, colour, width);
        plot.label(name, colour);
    }
    plot.save("perception_aware_rrt_star.png");
    std::puts("wrote perception_aware_rrt_star.png");
}
