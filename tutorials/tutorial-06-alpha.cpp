// SPDX-License-Identifier: BSD-3-Clause
// How much detour is certainty worth? The same problem for ten values of alpha: each answer is a
// point on the curve of what one can have, from the shortest path to the most certain one.
#include <cstdio>

#include "planning_problem.hpp"
#include "plot.hpp"
#include "two_textures.hpp"

using namespace photonav;
using namespace planning_problem;

namespace {

constexpr unsigned kVertices = 800;
constexpr double kViewPitch = 0.25;  // one view stands for its surroundings [m]

/// Orange for certainty, blue for haste.
cv::Scalar colourOf(double alpha) { return {230. * (1. - alpha), 100., 40. + 200. * alpha}; }

}  // namespace

int main(int argc, char** argv) {
    const MeshRenderer floor = two_textures::loadFloor(argc, argv);
    const Problem problem{two_textures::flightSpace(), {0., 0., 2.}, {2., 9., 2.}};
    const auto field = two_textures::views(floor, kViewPitch);  // views do not depend on alpha
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-2., -1.5), Eigen::Vector2d(10., 12.));
    Plot fromAbovePlot(area, 34.);
    const ImageF picture = fromAbove(floor, area, 34);
    fromAbovePlot.picture(picture.bitmap, picture.getHeight(), picture.getWidth());
    Plot tradeOff({Eigen::Vector2d(9., 0.), Eigen::Vector2d(14., 32.)}, {90., 14.}, "length [m]",
                  "mean trace [0.01 m^2]");

    //! [sweep]
    std::puts("alpha  length [m]  mean trace  goal trace [0.01 m^2]  new views");
    Plot::Points answers;
    for (int i = 0; i < 10; ++i) {
        const double alpha = 0.05 + 0.1 * i;
        const std::size_t viewsBefore = field->views();
        const BeliefOptions beliefs = two_textures::beliefs(alpha);
        const auto planner = makePlanner("belief_rrt_star", problem, field, beliefs, kVertices);
        BeliefModel judge(problem.space, field, beliefs);
        const std::vector<BeliefPoint> path = plan(*planner, judge);
        answers.emplace_back(path.back().distance, 100. * meanTrace(path));
        std::printf("%5.2f %10.2f  %10.2f  %10.2f  %19zu\n", alpha, answers.back().x(),
                    answers.back().y(), 100. * path.back().trace, field->views() - viewsBefore);
        //! [sweep]
        fromAbovePlot.curve(route(path), colourOf(alpha), 3);
        tradeOff.dots({answers.back()}, colourOf(alpha), 1., 6);
        if (i % 3 == 0) {
            fromAbovePlot.label("alpha " + std::to_string(alpha).substr(0, 4), colourOf(alpha));
        }
    }
    tradeOff.curve(answers, {120, 120, 120}, 1);
    fromAbovePlot.save("alpha_paths.png");
    tradeOff.save("alpha_trade_off.png");
    std::puts("wrote alpha_paths.png and alpha_trade_off.png");
}
