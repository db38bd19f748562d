// SPDX-License-Identifier: BSD-3-Clause
// Why one belief per vertex is not enough. Stripes in the corner of the room inform about the
// position, but lie out of the way: a robot that observed them comes back late and certain. A
// planner that keeps only the cheapest belief of every vertex drops that one for the beliefs of
// straight paths.
#include <cstdio>

#include "exercises.hpp"
#include "figures/images.hpp"
#include "io/error.hpp"
#include "plot/figure.hpp"
#include "problem/planning_problem.hpp"

using namespace photonav;

namespace {

struct Method {
    const char* name;
    const char* planner;
    unsigned labels;
    Color color;
    double width;  // of its line [pixels]
};

std::vector<Method> methods() {
    return {{"Algorithm 1", "pa_rrt_star", 1, plannerColor("pa_rrt_star"), 5.},
            {"search, 1 label", "belief_rrt_star", 1, kPurple, 3.},
            {"search, 5 labels", "belief_rrt_star", 5, plannerColor("belief_rrt_star"), 3.}};
}

//! [forced]
/// The end of a flight through given places, at 2 m height.
BeliefPoint endOf(PlanningProblem& problem, const std::vector<Eigen::Vector2d>& corners) {
    std::vector<Place> places;
    for (const Eigen::Vector2d& corner : corners) {
        places.push_back({{corner.x(), corner.y(), 2.}, {}});
    }
    return problem.evaluate("given waypoints", places).points.back();
}

const Eigen::Vector2d kStart(0., 0.), kStripes(18.6, 0.8), kMeeting(10.5, 11.), kGoal(5., 19.);

/// What a way to kMeeting costs there, what is known there, and what it costs to go on to the goal.
void report(PlanningProblem& problem, const char* way, std::vector<Eigen::Vector2d> corners) {
    const BeliefPoint here = endOf(problem, corners);
    corners.push_back(kGoal);
    const Matrix6& S = here.covariance;  // camera x is world x, camera y is world -y
    std::printf("%-22s %11.2f %14.3f %8.3f %18.2f\n", way, here.cost, std::sqrt(S(0, 0)),
                std::sqrt(S(1, 1)), endOf(problem, corners).cost);
}
//! [forced]

std::vector<Exercise> exercises(const Config& config, const World& world) {
    const auto costs = [&](double alpha) {  // straight, and past the stripes
        PlanningProblem problem(config, world, alpha);
        return Eigen::Vector2d(endOf(problem, {kStart, kMeeting, kGoal}).cost,
                               endOf(problem, {kStart, kStripes, kMeeting, kGoal}).cost);
    };
    // J is linear in alpha: at which alpha do the two lines meet?
    return {{[=] { return costs(0.75)[1]; }}, {[=] {
                const Eigen::Vector2d uncertainty = costs(0.), length = costs(1.);
                const double detour = length[1] - length[0];
                const double gain = uncertainty[0] - uncertainty[1];
                return gain / (gain + detour);
            }}};
}

}  // namespace

int main(int argc, char** argv) try {
    //! [problem]
    std::vector<std::string> settings{"planner.alpha=0.25", "planner.vertices=900",
                                      "planner.view_pitch=0.25"};
    if (argc > 1 && !asksForCheck(argc, argv))
        settings.push_back(std::string("scene.file=") + argv[1]);
    Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/stripes.yaml", settings);
    const World world(config);
    //! [problem]
    if (const auto code = checkAnswers(argc, argv, exercises(config, world))) return *code;
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-2., -2.), Eigen::Vector2d(22., 22.));
    Plot plot = Plot::map(area, 580.);
    plot.picture(greyPicture(world.pictureFromAbove(area, 2., 1. / 24.)), area, true);

    std::puts("planner               length [m]  mean trace [m^2]  goal trace [m^2]    cost");
    for (const auto& [name, planner, labels, color, width] : methods()) {
        config.search.labels = labels;
        const EvaluatedPath path = PlanningProblem(config, world).solve(planner).path.value();
        std::printf("%-20s %11.2f  %16.4f  %16.4f  %7.3f\n", name, path.length, path.meanTrace,
                    path.goalTrace, path.cost);
        plot.curve(path.fromAbove(), {.color = color, .width = width, .name = name, .halo = 1.});
    }

    // Two beliefs that meet half way to the goal: one came straight, one past both stripes.
    PlanningProblem problem(config, world);
    std::puts("\nway to (10.5, 11)       cost there   std of x, y there [m]   cost at the goal");
    report(problem, "straight", {kStart, kMeeting});
    report(problem, "past the stripes", {kStart, kStripes, kMeeting});
    Figure{"Beliefs kept per vertex", {{plot}}, Figure::Legend::right}.save(
        "one_belief_is_not_enough.png");
    std::puts("wrote one_belief_is_not_enough.png");
} catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
