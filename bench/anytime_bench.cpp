// SPDX-License-Identifier: BSD-3-Clause
// J over time: the best path of belief_rrt_star, of Algorithm 1 and of OMPL's RRTstar after given
// times, on the paper's two scenarios and in a room. Seconds are processor time of this process
// (one thread), views included; every planner starts without cached views. The row "known time" has
// solve(seconds), begun anew for each time, by the wall clock; below it is the share of the time
// that was used.
#include <fmt/format.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

#include "bench_arguments.hpp"
#include "problem/planning_problem.hpp"
#include "thread_time.hpp"

namespace {

using namespace photonav;
namespace ob = ompl::base;

/// Costs of one planner's best paths after each of the times; infinite: none yet.
using Curve = std::vector<double>;

/// Continues solving until each of the times; `costOf` evaluates the solution at that time.
template <typename CostOf>
Curve measure(ob::Planner& planner, const std::vector<double>& times, const CostOf& costOf) {
    Curve curve;
    double evaluating = 0.;  // not counted
    const double start = processSeconds();
    const auto used = [&] { return processSeconds() - start - evaluating; };
    for (const double time : times) {
        planner.solve(ob::PlannerTerminationCondition([&] { return used() >= time; }));
        const double before = processSeconds();
        curve.push_back(costOf());
        evaluating += processSeconds() - before;
    }
    return curve;
}

/// One without limits, and without cached views.
std::shared_ptr<BeliefPlanner> freshPlanner(PlanningProblem& problem, const std::string& name,
                                            unsigned seed) {
    problem.forgetViews();
    auto planner = problem.makePlanner(name);
    planner->params().setParam("seed", std::to_string(seed));
    planner->params().setParam("max_vertices", "0");
    planner->params().setParam("max_iterations", "0");
    return planner;
}

Curve measureOurs(PlanningProblem& problem, const std::string& name, unsigned seed,
                  const std::vector<double>& times) {
    const auto planner = freshPlanner(problem, name, seed);
    return measure(*planner, times, [&] { return planner->bestCost(); });
}

/// Costs, and the share of each time that was used, when the planner knows the time in advance.
struct KnownTime {
    Curve cost, used;
};

KnownTime measureKnownTime(PlanningProblem& problem, unsigned seed,
                           const std::vector<double>& times) {
    KnownTime result;
    for (const double time : times) {
        const auto planner = freshPlanner(problem, "belief_rrt_star", seed);
        const auto start = std::chrono::steady_clock::now();
        planner->solve(time);
        const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start;
        result.cost.push_back(planner->bestCost());
        result.used.push_back(used.count() / time);
    }
    return result;
}

/// The shortest path that OMPL's RRTstar finds, with the neighbourhood that ours has.
Curve measureOmpl(PlanningProblem& problem, unsigned seed, const std::vector<double>& times) {
    ompl::RNG::setSeed(seed);
    problem.forgetViews();
    const auto evaluator = problem.makePlanner("belief_rrt_star");
    const auto& si = problem.spaceInformation();
    const ob::ProblemDefinitionPtr definition = problem.definition();
    ompl::geometric::RRTstar planner(si);
    planner.setKNearest(false);
    planner.setRange(0.2 * si->getMaximumExtent());
    planner.setProblemDefinition(definition);
    planner.setup();
    return measure(planner, times, [&] {
        if (!definition->hasExactSolution()) return kInfinity;
        auto& path = *definition->getSolutionPath()->as<ompl::geometric::PathGeometric>();
        return evaluator->model()
            .evaluate({path.getStates().begin(), path.getStates().end()})
            .back()
            .cost;
    });
}

/// Mean over the seeds that have a path, and how many have none.
void printRow(const std::string& name, const std::vector<Curve>& curves) {
    fmt::print("| {} |", name);
    for (std::size_t i = 0; i < curves.front().size(); ++i) {
        double sum = 0.;
        std::size_t found = 0;
        for (const Curve& curve : curves) {
            if (curve[i] == kInfinity) continue;
            sum += curve[i];
            ++found;
        }
        const std::size_t without = curves.size() - found;
        fmt::print(" {}{} |", found > 0 ? fmt::format("{:.4g}", sum / found) : "none",
                   found > 0 && without > 0 ? fmt::format(" ({} none)", without) : "");
    }
    fmt::print("\n");
    std::fflush(stdout);
}

void printTable(const std::string& scenario, unsigned seeds, const std::vector<double>& times) {
    const Config config =
        loadConfig(fmt::format("{}/config/{}.yaml", PHOTONAV_SOURCE_DIR, scenario));
    const World world(config);
    PlanningProblem problem(config, world);
    fmt::print("\n| {}, {} seeds: J after |", scenario, seeds);
    for (const double time : times) fmt::print(" {} s |", time);
    fmt::print("\n|---|");
    for (std::size_t i = 0; i < times.size(); ++i) fmt::print("---|");
    fmt::print("\n");
    for (const std::string name : {"belief_rrt_star", "pa_rrt_star", "OMPL RRTstar"}) {
        std::vector<Curve> curves;
        for (unsigned seed = 1; seed <= seeds; ++seed) {
            curves.push_back(name == "OMPL RRTstar" ? measureOmpl(problem, seed, times)
                                                    : measureOurs(problem, name, seed, times));
        }
        printRow(name, curves);
    }
    std::vector<Curve> costs, used;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        const KnownTime known = measureKnownTime(problem, seed, times);
        costs.push_back(known.cost);
        used.push_back(known.used);
    }
    printRow("belief_rrt_star, known time", costs);
    printRow("share of it that was used", used);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "anytime_bench [SEEDS=10] [LONGEST_TIME=10]");
    ompl::msg::noOutputHandler();
    const auto seeds = arguments.number(1, 10U, 1U);
    const double longest = arguments.number(2, 10.);
    std::vector<double> times;
    for (const double time : {0.05, 0.1, 0.2, 0.5, 1., 2., 5., 10.}) {
        if (time <= longest) times.push_back(time);
    }
    for (const char* scenario : {"two_textures", "stripes", "room"}) {
        printTable(scenario, seeds, times);
    }
    return 0;
}
