// SPDX-License-Identifier: BSD-3-Clause
// Why one belief per vertex is not enough. Stripes in the corner of the room tell where one is, but
// lie out of the way; who has been there comes back late and sure. A planner that keeps only the
// cheapest belief at every vertex throws that one away when it meets those who came straight.
#include <cstdio>
#include <numbers>

#include "mesh_renderer.hpp"
#include "planning_problem.hpp"
#include "plot.hpp"
#include "scene_argument.hpp"

using namespace photonav;
using namespace planning_problem;

namespace {

constexpr unsigned kVertices = 900;
constexpr double kAlpha = 0.25;
constexpr double kHeading = std::numbers::pi / 2.;  // the image's long side along world x

//! [problem]
/// The paper's second scene: a robot 2 m above a white floor with two striped areas.
Problem stripesProblem() {
    return {{StateKind::position,
             {Eigen::Vector3d(0., 0., 2.), Eigen::Vector3d(20., 20., 2.)},
             0.25,
             kHeading},
            {0., 0., 2.},
            {5., 19., 2.}};
}

BeliefOptions beliefsOf() {
    BeliefOptions options;
    options.alpha = kAlpha;
    options.initialCovariance.diagonal() << 0.33, 0.20, 0.0825, 4e-6, 4e-6, 4e-5;  // body frame
    options.motionNoise.diagonal() << 1e-4, 1e-4, 1e-4, 4.5e-6, 4.5e-6, 1.35e-4;   // per metre
    return options;
}
//! [problem]

struct Contender {
    const char* name;
    const char* planner;
    unsigned labels;
    cv::Scalar colour;
    int width;  // of its line [pixels]
};

}  // namespace

int main(int argc, char** argv) {
    const MeshRenderer floor(sceneArgument(argc, argv, "stripes.yaml"));
    const Problem problem = stripesProblem();
    const BeliefOptions beliefs = beliefsOf();
    const auto field = std::make_shared<InformationField>(
        photometricModel(floor, makeCamera(188, 120, 70. * std::numbers::pi / 180.),
                         {.sigma = 0.02, .scale = 0.08}),
        cameraMount(std::numbers::pi / 2.), InformationField::Options{.positionPitch = 0.25});
    BeliefModel judge(problem.space, field, beliefs);
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-2., -2.), Eigen::Vector2d(22., 22.));
    Plot plot(area, 24.);
    const ImageF picture = fromAbove(floor, area, 24);
    plot.picture(picture.bitmap, picture.getHeight(), picture.getWidth());

    std::puts("planner               length [m]  mean trace  goal trace [0.01 m^2]    cost");
    const std::vector<Contender> contenders = {
        {"Algorithm 1", "pa_rrt_star", 1, {28, 108, 214}, 5},
        {"search, 1 label", "belief_rrt_star", 1, {38, 140, 122}, 3},
        {"search, 5 labels", "belief_rrt_star", 5, {222, 79, 12}, 3}};
    for (const auto& [name, kind, labels, colour, width] : contenders) {
        const auto planner = makePlanner(kind, problem, field, beliefs, kVertices, labels);
        const std::vector<BeliefPoint> path = plan(*planner, judge);
        std::printf("%-20s %11.2f  %10.2f  %10.2f  %16.3f\n", name, path.back().distance,
                    100. * meanTrace(path), 100. * path.back().trace, path.back().cost);
        plot.curve(route(path), colour, width);
        plot.label(name, colour, 390);
    }

    //! [forced]
    // Two beliefs that meet half way to the goal: one came straight, one past both stripes.
    const ompl::base::SpaceInformationPtr si = makeSpaceInformation(
        problem.space, [](const Eigen::Vector3d&) { return 1.; }, 0.3);
    const auto evaluate = [&](const std::vector<Eigen::Vector2d>& corners) {
        std::vector<ompl::base::ScopedState<>> states;
        std::vector<const ompl::base::State*> path;
        for (const Eigen::Vector2d& corner : corners) {
            states.emplace_back(si);
            problem.space.setState(states.back().get(), {corner.x(), corner.y(), 2.}, kHeading);
        }
        for (const auto& state : states) path.push_back(state.get());
        return judge.evaluate(path);
    };
    const Eigen::Vector2d start(0., 0.), stripes(18.6, 0.8), meeting(10.5, 11.), goal(5., 19.);
    std::puts("\nway to (10.5, 11)       cost there   std of x, y there [m]   cost at the goal");
    const auto report = [&](const char* way, std::vector<Eigen::Vector2d> corners) {
        const BeliefPoint here = evaluate(corners).back();
        corners.push_back(goal);
        const Matrix6& S = here.covariance;  // camera x is world x, camera y is world -y
        std::printf("%-22s %11.2f %14.3f %8.3f %18.2f\n", way, here.cost, std::sqrt(S(0, 0)),
                    std::sqrt(S(1, 1)), evaluate(corners).back().cost);
    };
    report("straight", {start, meeting});
    report("past the stripes", {start, stripes, meeting});
    //! [forced]
    plot.save("one_belief_is_not_enough.png");
    std::puts("wrote one_belief_is_not_enough.png");
}
