// SPDX-License-Identifier: BSD-3-Clause
// Three planners, one question: from start to goal over a floor that is half white, half textured.
// RRT* flies straight over white; the perception-aware ones pay a detour to see where they are.
#include <cstdio>

#include "planning_problem.hpp"
#include "plot.hpp"
#include "two_textures.hpp"

using namespace photonav;
using namespace planning_problem;

namespace {

constexpr unsigned kVertices = 600;
constexpr double kAlpha = 0.1;       // 1: the shortest way, 0: the most certain one
constexpr double kViewPitch = 0.25;  // one view stands for its surroundings [m]

struct Contender {
    std::string name;
    cv::Scalar colour;
    int width;  // of its line [pixels]
};

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

}  // namespace

int main(int argc, char** argv) {
    const MeshRenderer floor = two_textures::loadFloor(argc, argv);
    const Problem problem{two_textures::flightSpace(), {0., 0., 2.}, {2., 9., 2.}};
    const auto field = two_textures::views(floor, kViewPitch);
    BeliefModel judge(problem.space, field, two_textures::beliefs(kAlpha));
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-2., -1.5), Eigen::Vector2d(10., 12.));
    Plot plot(area, 34.);
    const ImageF picture = fromAbove(floor, area, 34);
    plot.picture(picture.bitmap, picture.getHeight(), picture.getWidth());

    std::puts("planner          length [m]  mean trace  goal trace [0.01 m^2]    cost   views");
    const std::vector<Contender> contenders = {{"rrt_star", {200, 60, 40}, 3},
                                               {"pa_rrt_star", {240, 150, 20}, 5},
                                               {"belief_rrt_star", {20, 60, 200}, 2}};
    for (const auto& [name, colour, width] : contenders) {
        const auto planner = makePlanner(name, problem, two_textures::views(floor, kViewPitch),
                                         two_textures::beliefs(kAlpha), kVertices);
        const std::vector<BeliefPoint> path = plan(*planner, judge);
        std::printf("%-16s %9.2f  %10.2f  %10.2f  %16.3f  %6zu\n", name.c_str(),
                    path.back().distance, 100. * meanTrace(path), 100. * path.back().trace,
                    path.back().cost, planner->model().field().views());
        for (std::size_t i = 0; i < path.size(); i += 6) {
            plot.curve(ellipse(path[i], field->mount()), colour, 1);
        }
        plot.curve(route(path), colour, width);
        plot.label(name, colour);
    }
    plot.save("perception_aware_rrt_star.png");
    std::puts("wrote perception_aware_rrt_star.png");
}
