// SPDX-License-Identifier: BSD-3-Clause
// Time per vertex of the trees, without images: the information of a view is a formula here. OMPL's
// own RRTstar grows in the same run for comparison. Without arguments: a few seconds at 5000
// vertices. `tables`: time and memory from 1000 to 100000 vertices, and cost over time at alpha =
// 1.
#include <fmt/format.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <malloc.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <numbers>
#include <string_view>

#include "bench_arguments.hpp"
#include "planners/planner_table.hpp"
#include "thread_time.hpp"

namespace {

using namespace photonav;
namespace ob = ompl::base;

constexpr std::size_t kVertices = 5000;
constexpr int kRepetitions = 3;

/// Texture for x > 6, nothing elsewhere.
Matrix6 texture(const Pose& T_c_w) {
    const bool isSeen = T_c_w.inverse().translation().x() > 6.;
    return isSeen ? Matrix6(1e3 * Matrix6::Identity()) : Matrix6(Matrix6::Zero());
}

double clearance(const Eigen::Vector3d& p) { return (p - Eigen::Vector3d(5, 5, 1)).norm() - 1.; }

struct Bench {
    FlightSpace space;
    ob::SpaceInformationPtr si = makeSpaceInformation(space, clearance, 0.3);

    ob::ProblemDefinitionPtr definition() const {
        ob::ScopedState<> start(si);
        ob::ScopedState<> goal(si);
        space.setState(start.get(), {1., 1., 1.}, 0.);
        space.setState(goal.get(), {2., 9., 1.}, 0.);
        auto definition = std::make_shared<ob::ProblemDefinition>(si);
        definition->setStartAndGoalStates(start, goal);
        return definition;
    }

    std::shared_ptr<BeliefPlanner> planner(const std::string& name, std::uint32_t seed,
                                           unsigned maxVertices = kVertices) const {
        BeliefOptions options;
        options.alpha = 0.1;
        options.initialCovariance.diagonal() << .1, .1, .05, 1e-5, 1e-5, 1e-4;
        options.motionNoise.diagonal() << 1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-4;
        const auto model = std::make_shared<BeliefModel>(
            space,
            std::make_shared<InformationField>(texture, cameraMount(std::numbers::pi / 2),
                                               InformationField::Options{}),
            options);
        GrowthOptions growth;
        growth.seed = seed;
        growth.maxVertices = maxVertices;
        return makePlanner(name, si, model, {}, growth);
    }
};

/// Least microseconds per vertex over the repetitions.
template <typename Make, typename Done>
double measure(const Bench& bench, const Make& make, const Done& isDone) {
    double best = 1e300;
    for (int i = 1; i <= kRepetitions; ++i) {
        auto planner = make(static_cast<std::uint32_t>(i));
        planner->setProblemDefinition(bench.definition());
        planner->setup();
        const std::clock_t start = std::clock();  // of this process: one thread, whatever else runs
        planner->solve(ob::PlannerTerminationCondition([&] { return isDone(*planner); }));
        const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        best = std::min(best, 1e6 * seconds / kVertices);
    }
    return best;
}

/// OMPL's RRTstar with the neighbourhood that ours has.
std::unique_ptr<ompl::geometric::RRTstar> omplPlanner(const Bench& bench) {
    auto planner = std::make_unique<ompl::geometric::RRTstar>(bench.si);
    planner->setKNearest(false);
    planner->setRange(0.2 * bench.si->getMaximumExtent());
    return planner;
}

void run(const char* title, const Bench& bench) {
    fmt::print("{}, {} vertices\n", title, kVertices);
    unsigned iterations = 0;
    const double ompls = measure(
        bench,
        [&](std::uint32_t) {
            iterations = 0;
            return omplPlanner(bench);
        },
        [&](const auto&) { return iterations++ >= kVertices; });
    fmt::print("  {:<28} {:8.1f} us/vertex\n", "OMPL RRTstar (radius)", ompls);
    for (const char* name : {"rrt_star", "pa_rrt_star", "belief_rrt_star"}) {
        const double ours = measure(
            bench, [&](std::uint32_t seed) { return bench.planner(name, seed); },
            [](const BeliefPlanner&) { return false; });
        fmt::print("  {:<28} {:8.1f} us/vertex   {:5.2f} of OMPL's\n", name, ours, ours / ompls);
    }
}

/// Resident memory of this process [MB].
double residentMegabytes() {
    std::ifstream statm("/proc/self/statm");
    double total = 0.;
    double resident = 0.;
    statm >> total >> resident;
    return 1e-6 * resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Exponent of y over x between the first and the last.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
    return std::log(y.back() / y.front()) / std::log(x.back() / x.front());
}

/// A row of the table: time and memory of a fresh planner at each size, and their exponents.
void printGrowth(const Bench& bench, const std::string& name, unsigned maxVertices) {
    std::vector<double> sizes;
    std::vector<double> seconds;
    std::vector<double> megabytes;
    fmt::print("| `{}` |", name);
    for (double size = 1e3; size < 1.001 * maxVertices; size *= std::sqrt(10.)) {
        auto planner = bench.planner(name, 1, static_cast<unsigned>(std::lround(size)));
        planner->setProblemDefinition(bench.definition());
        planner->setup();
        malloc_trim(0);
        const double memoryBefore = residentMegabytes();
        const double start = processSeconds();
        planner->solve(ob::PlannerTerminationCondition([] { return false; }));
        sizes.push_back(size);
        seconds.push_back(processSeconds() - start);
        megabytes.push_back(residentMegabytes() - memoryBefore);
        fmt::print(" {:.3g} s, {:.3g} MB |", seconds.back(), megabytes.back());
        std::fflush(stdout);
    }
    fmt::print(" {:.2f}, {:.2f} |\n", exponent(sizes, seconds), exponent(sizes, megabytes));
}

constexpr std::array kTimes = {0.03, 0.1, 0.3, 1., 3.};

/// A row of the table: mean path length over the repetitions after each of the times.
template <typename Make>
void printConvergence(const Bench& bench, const char* name, const Make& make) {
    std::array<double, kTimes.size()> length = {};
    for (int seed = 1; seed <= kRepetitions; ++seed) {
        auto planner = make(static_cast<std::uint32_t>(seed));
        const ob::ProblemDefinitionPtr definition = bench.definition();
        planner->setProblemDefinition(definition);
        planner->setup();
        const double start = processSeconds();
        for (std::size_t i = 0; i < kTimes.size(); ++i) {
            planner->solve(ob::PlannerTerminationCondition(
                [&] { return processSeconds() - start >= kTimes[i]; }));
            length[i] += definition->hasExactSolution()
                             ? definition->getSolutionPath()->length() / kRepetitions
                             : std::numeric_limits<double>::infinity();
        }
    }
    fmt::print("| {} |", name);
    for (double metres : length) fmt::print(" {:.3f} |", metres);
    fmt::print("\n");
}

void printTables(const Bench& bench) {
    fmt::print(
        "| (x, y, z) | 1000 | 3162 | 10000 | 31623 | 100000 | exponents |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const char* name : {"rrt_star", "pa_rrt_star", "belief_rrt_star"}) {
        printGrowth(bench, name, 100000);
    }
    fmt::print(
        "\n| path [m] after | 0.03 s | 0.1 s | 0.3 s | 1 s | 3 s |\n|---|---|---|---|---|---|\n");
    printConvergence(bench, "OMPL RRTstar", [&](std::uint32_t) { return omplPlanner(bench); });
    printConvergence(bench, "`rrt_star`",
                     [&](std::uint32_t seed) { return bench.planner("rrt_star", seed, 0); });
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "planner_bench [tables]");
    ompl::msg::noOutputHandler();
    const Eigen::AlignedBox3d box(Eigen::Vector3d::Zero(), Eigen::Vector3d(10., 10., 3.));
    if (arguments.text(1, "") == "tables") {
        printTables(Bench{FlightSpace(StateKind::position, box)});
        return 0;
    }
    run("(x, y, z)", Bench{FlightSpace(StateKind::position, box)});
    run("(x, y, z, yaw)", Bench{FlightSpace(StateKind::positionYaw, box)});
    return 0;
}
