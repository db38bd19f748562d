// SPDX-License-Identifier: BSD-3-Clause
// How much detour is certainty worth? The same problem for ten values of alpha: each solution is a
// point on the front between the shortest and the most certain path.
#include <cstdio>

#include "exercises.hpp"
#include "figures/images.hpp"
#include "io/error.hpp"
#include "plot/figure.hpp"
#include "problem/planning_problem.hpp"

using namespace photonav;

namespace {

/// Dark for certain paths, bright for short ones.
Color colorOf(double alpha) { return viridis(0.94 * alpha); }

/// Length and integral of the trace of a path.
Eigen::Vector2d partsOf(const EvaluatedPath& path) {
    return {path.length, path.length * path.meanTrace};
}

std::vector<Exercise> exercises(const Config& config, const World& world) {
    const auto straight = [&] {
        return partsOf(
            PlanningProblem(config, world).evaluate("straight", {config.start, config.goal}));
    };
    const auto detour = [&] {
        return partsOf(PlanningProblem(config, world, 0.55).solve("belief_rrt_star").path.value());
    };
    return {{[=] { return straight()[0] / straight()[1]; }}, {[=] {
                const Eigen::Vector2d more = detour() - straight();
                const double gain = -2.5 * more[1];
                return gain / (gain + more[0]);
            }}};
}

}  // namespace

int main(int argc, char** argv) try {
    std::vector<std::string> settings{"planner.vertices=800", "planner.view_pitch=0.25"};
    if (argc > 1 && !asksForCheck(argc, argv))
        settings.push_back(std::string("scene.file=") + argv[1]);
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", settings);
    const World world(config);
    if (const auto code = checkAnswers(argc, argv, exercises(config, world))) return *code;
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-2., -1.5), Eigen::Vector2d(10., 12.));
    Plot paths = Plot::map(area, 460.);
    paths.picture(greyPicture(world.pictureFromAbove(area, 2., 1. / 34.)), area, true);
    Plot tradeOff;
    tradeOff.x.label = "length [m]";
    tradeOff.y = {.min = 0., .label = "mean trace [m²]"};
    tradeOff.width = tradeOff.height = 440.;

    //! [sweep]
    std::puts("alpha  length [m]  mean trace [m^2]  goal trace [m^2]  new views");
    const PlanningProblem problem(config, world);
    Plot::Points answers;
    std::size_t viewsBefore = 0;
    for (int i = 0; i < 10; ++i) {
        const double alpha = 0.05 + 0.1 * i;
        const PlanOutcome outcome = PlanningProblem(problem, alpha).solve("belief_rrt_star");
        const EvaluatedPath& path = outcome.path.value();
        answers.emplace_back(path.length, path.meanTrace);
        std::printf("%5.2f %11.2f  %16.4f  %16.4f  %9zu\n", alpha, answers.back().x(),
                    answers.back().y(), path.goalTrace, outcome.views - viewsBefore);
        viewsBefore = outcome.views;
        //! [sweep]
        const std::string name =
            i % 3 == 0 ? "alpha " + std::to_string(alpha).substr(0, 4) : std::string();
        paths.curve(path.fromAbove(),
                    {.color = colorOf(alpha), .width = 3., .name = name, .halo = 1.});
        tradeOff.dots({answers.back()}, {.color = colorOf(alpha), .width = 12.});
    }
    tradeOff.curve(answers, {.color = {120, 120, 120}, .width = 1.});
    Figure{"Paths for ten values of alpha", {{paths}}, Figure::Legend::right}.save(
        "alpha_paths.png");
    Figure{"Length and uncertainty", {{tradeOff}}}.save("alpha_trade_off.png");
    std::puts("wrote alpha_paths.png and alpha_trade_off.png");
} catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
