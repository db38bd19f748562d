// SPDX-License-Identifier: BSD-3-Clause
// What happens to a belief along an edge? At every step of ds it is propagated, its cost is added,
// and it is updated by the view from there. First by hand, then by the planners' BeliefModel.
#include <ompl/base/ScopedState.h>

#include <cstdio>
#include <limits>

#include "exercises.hpp"
#include "geometry/se3.hpp"
#include "plot/figure.hpp"
#include "two_textures.hpp"

using namespace photonav;
namespace ob = ompl::base;

namespace {

struct Step {
    double distance, traceBefore, traceAfter, cost;
};

//! [by-hand]
/// Propagates a belief along a straight motion, step by step; `T_c_w` is the belief at its
/// beginning, then at its end.
void propagateByHand(BeliefModel& model, const ob::State* from, const ob::State* to,
                     UncertainPose& T_c_w, std::vector<Step>& steps) {
    const BeliefOptions& options = model.options();
    const Pose T_c_b = model.field().mount().inverse();
    const Matrix6 noise = adjoint(T_c_b) * options.motionNoise * adjoint(T_c_b).transpose();
    const double length = model.space().space()->distance(from, to);
    const int count = static_cast<int>(std::lround(length / options.ds));
    for (int k = 1; k <= count; ++k) {
        Step step = steps.back();
        const double traceLast = step.traceAfter;
        // 1. Propagate: the motion adds its own noise.
        const Pose T_w_b = model.space().poseBetween(from, to, static_cast<double>(k) / count);
        const UncertainPose motion{T_c_b * T_w_b.inverse() * T_c_w.mean.inverse(),
                                   options.ds * noise};
        T_c_w = compound(motion, T_c_w);
        step.traceBefore = weightedTrace(T_c_w.covariance);
        // 2. Cost: the distance, and the integral of the trace along it.
        step.distance += options.ds;
        step.cost += options.alpha * options.ds + (1. - options.alpha) * options.kappa *
                                                      options.ds * 0.5 *
                                                      (traceLast + step.traceBefore);
        // 3. Update by the view from here.
        T_c_w.covariance = updateCovariance(T_c_w.covariance, model.informationAt(T_w_b));
        step.traceAfter = weightedTrace(T_c_w.covariance);
        steps.push_back(step);
    }
}
//! [by-hand]

/// States along the line y = 4 m.
std::vector<ob::ScopedState<>> statesAt(const FlightSpace& space, const std::vector<double>& xs) {
    std::vector<ob::ScopedState<>> states;
    for (const double x : xs) {
        states.emplace_back(space.space());
        space.setState(states.back().get(), {x, 4., 2.}, 0.);
    }
    return states;
}

//! [propagate]
/// Cost of flying through these places, edge by edge, as planners compute it.
double costAlong(BeliefModel& model, const std::vector<double>& xs) {
    const auto states = statesAt(model.space(), xs);
    Belief belief = model.root(states.front().get());
    for (std::size_t i = 1; i < states.size(); ++i) {
        Motion motion = model.motion(states[i - 1].get(), states[i].get());
        belief = model.propagate(belief, motion);
    }
    return belief.cost;
}
//! [propagate]

std::vector<Exercise> exercises(const std::shared_ptr<InformationField>& field) {
    const auto costOver = [=](double alpha, const std::vector<double>& xs) {
        BeliefModel model(two_textures::flightSpace(), field, two_textures::beliefs(alpha));
        return costAlong(model, xs);
    };
    // With alpha 0, J is kappa times the integral of the trace.
    const double kappa = two_textures::beliefs(0.).kappa;
    return {{[=] {
                return costOver(0.5, {1., 3.});
            }},
            {[=] {
                return 2. / (costOver(0., {1., 3.}) / kappa);
            }}};
}

void draw(const std::vector<Step>& steps) {
    Plot plot;
    plot.x = {.min = 0., .label = "distance flown [m]"};
    plot.y = {.log = true, .label = "trace [m²]"};
    Plot::Points traces;
    for (const Step& step : steps) {
        traces.emplace_back(step.distance, step.traceBefore);
        traces.emplace_back(step.distance, step.traceAfter);
    }
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double border : {3.95, 8.05}) {  // x = 4.95 m, there and back
        plot.curve({{border, -infinity}, {border, infinity}},
                   {.color = {230, 140, 20}, .name = "above the border of the texture"});
    }
    plot.curve(traces, {.color = {20, 60, 160}, .name = "up with motions, down with views"});
    Figure{"Belief along an edge", {{plot}}}.save("edge_belief.png");
}

}  // namespace

int main(int argc, char** argv) {
    const auto floor = two_textures::loadFloor(argc, argv);
    const auto field = two_textures::views(floor, 0.1);
    BeliefModel model(two_textures::flightSpace(), field, two_textures::beliefs(0.1));
    if (const auto code = checkAnswers(argc, argv, exercises(field))) return *code;

    //! [there-and-back]
    const auto way = statesAt(model.space(), {1., 7., 1.});
    const Pose T_w_c = model.space().bodyPose(way[0].get()) * field->mount();
    UncertainPose T_c_w{T_w_c.inverse(), model.initialCovariance()};
    const double trace = weightedTrace(T_c_w.covariance);
    std::vector<Step> steps{{0., trace, trace, 0.}};
    propagateByHand(model, way[0].get(), way[1].get(), T_c_w, steps);
    propagateByHand(model, way[1].get(), way[2].get(), T_c_w, steps);
    //! [there-and-back]
    std::puts("  way [m]  trace before view     after      cost");
    for (std::size_t i = 0; i < steps.size(); i += 4) {
        std::printf("  %5.2f         %10.6f  %10.6f  %7.4f\n", steps[i].distance,
                    steps[i].traceBefore, steps[i].traceAfter, steps[i].cost);
    }

    //! [evaluate]
    const double byHand = steps.back().cost;
    const double flown = costAlong(model, {1., 7., 1.});
    const double evaluated = model.evaluate({way[0].get(), way[1].get(), way[2].get()}).back().cost;
    //! [evaluate]
    std::printf("cost by hand %.9f, propagate() %.9f, evaluate() %.9f\n", byHand, flown, evaluated);

    //! [cuts]
    BeliefOptions options = model.options();
    options.ds = 0.05;
    BeliefModel fine(model.space(), field, options);
    options.cost = CostRule::perVertex;  // the paper's sum over vertices
    BeliefModel perVertex(model.space(), field, options);
    for (const auto& xs : {std::vector{1., 7., 1.},
                           {1., 4., 7., 4., 1.},
                           {1., 2.3, 2.9, 5.2, 6.1, 7., 3.7, 2.2, 1.}}) {
        std::printf("%zu edges: cost %.3f, with ds = 5 cm %.3f; charged per vertex %.3f\n",
                    xs.size() - 1, costAlong(model, xs), costAlong(fine, xs),
                    costAlong(perVertex, xs));
    }
    //! [cuts]
    draw(steps);
    std::puts("wrote edge_belief.png");
}
