// SPDX-License-Identifier: BSD-3-Clause
// Time per vertex of the trees, without images: what a view is worth is a formula here. OMPL's own
// RRTstar grows in the same run as the yardstick.
#include <fmt/format.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <ctime>
#include <numbers>

#include "belief_rrt_star.hpp"
#include "perception_rrt_star.hpp"

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

    std::unique_ptr<BeliefPlanner> planner(const std::string& name, std::uint32_t seed) const {
        BeliefOptions options;
        options.alpha = name == "rrt_star" ? 1. : 0.1;
        options.initialCovariance.diagonal() << .1, .1, .05, 1e-5, 1e-5, 1e-4;
        options.motionNoise.diagonal() << 1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-4;
        const auto model = std::make_shared<BeliefModel>(
            space,
            std::make_shared<InformationField>(texture, cameraMount(std::numbers::pi / 2),
                                               InformationField::Options{}),
            options);
        GrowthOptions growth;
        growth.seed = seed;
        growth.maxVertices = kVertices;
        if (name == "belief_rrt_star") {
            return std::make_unique<BeliefRRTstar>(si, model, SearchOptions{}, growth);
        }
        return std::make_unique<PerceptionRRTstar>(si, model, growth);
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

void run(const char* title, const Bench& bench) {
    fmt::print("{}, {} vertices\n", title, kVertices);
    unsigned iterations = 0;
    const double ompls = measure(
        bench,
        [&](std::uint32_t) {
            iterations = 0;
            auto planner = std::make_unique<ompl::geometric::RRTstar>(bench.si);
            planner->setKNearest(false);
            planner->setRange(0.2 * bench.si->getMaximumExtent());
            return planner;
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

}  // namespace

int main() {
    ompl::msg::noOutputHandler();
    const Eigen::AlignedBox3d box(Eigen::Vector3d::Zero(), Eigen::Vector3d(10., 10., 3.));
    run("(x, y, z)", Bench{FlightSpace(StateKind::position, box)});
    run("(x, y, z, yaw)", Bench{FlightSpace(StateKind::positionYaw, box)});
    return 0;
}
