// SPDX-License-Identifier: BSD-3-Clause
#include "problem/tree_evolution.hpp"

#include <set>
#include <utility>

#include "io/interrupted.hpp"
#include "io/stopwatch.hpp"

namespace photonav {
namespace ob = ompl::base;

namespace {

TreeStage grow(BeliefPlanner& planner, PlanningProblem& problem,
               const std::atomic<bool>& interrupted, const OnPlanProgress& onProgress) {
    TreeStage stage;
    const InterruptionScope scope = problem.interruptedBy(interrupted);
    problem.grow(planner, interrupted, onProgress);
    stage.vertices = planner.vertices();
    stage.tree = drawnEdges(planner);
    if (planner.bestPath().empty()) return stage;
    for (const ob::State* state : planner.bestPath()) {
        stage.path.push_back(planner.model().space().position(state));
    }
    const auto& path = planner.bestPath();
    stage.cost =
        problem.evaluator().evaluate({path.begin(), path.end()}, planner.movedRoot()).back().cost;
    return stage;
}

}  // namespace

TreeEvolution growInStages(PlanningProblem& problem, const std::string& name,
                           const std::vector<std::size_t>& vertices,
                           const std::atomic<bool>& interrupted, const OnPlanProgress& onProgress) {
    const Stopwatch watch;
    const auto onGrowth = [&](PlanProgress progress) {
        progress.seconds = watch.seconds();  // not that of the stage
        if (onProgress) onProgress(progress);
    };
    const auto planner = problem.makePlanner(name);
    TreeEvolution evolution{planner->getName(), {}};
    for (const std::size_t stop : vertices) {
        planner->params().setParam("max_vertices", std::to_string(stop));
        try {
            TreeStage stage = grow(*planner, problem, interrupted, onGrowth);
            if (interrupted) break;
            evolution.stages.push_back(std::move(stage));
        } catch (const Interrupted&) {
            break;
        }
    }
    return evolution;
}

std::vector<TreeSegment> drawnEdges(const BeliefPlanner& planner) {
    const FlightSpace& space = planner.model().space();
    const auto nodes = planner.tree();
    std::set<std::pair<const ob::State*, const ob::State*>> drawn;
    std::vector<TreeSegment> edges;
    for (const TreeNode& node : nodes) {
        if (node.parent < 0) continue;
        const ob::State* parent = nodes[node.parent].state;
        if (!drawn.emplace(std::minmax(parent, node.state)).second) continue;
        edges.push_back(
            {space.position(parent).cast<float>(), space.position(node.state).cast<float>()});
    }
    return edges;
}

}  // namespace photonav
