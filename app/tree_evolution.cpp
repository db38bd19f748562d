// SPDX-License-Identifier: BSD-3-Clause
#include "tree_evolution.hpp"

#include <fmt/format.h>
#include <ompl/geometric/PathGeometric.h>

#include <algorithm>
#include <set>

namespace photonav {
namespace ob = ompl::base;
namespace {

double lengthOf(const std::vector<Eigen::Vector3d>& path) {
    double length = 0.;
    for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
    return length;
}

}  // namespace

TreeEvolution growInStages(PlanRun& run, const std::string& name,
                           const std::vector<std::size_t>& vertices,
                           const std::atomic<bool>& interrupted) {
    const auto planner = run.makePlanner(name);
    const FlightSpace& space = planner->model().space();
    TreeEvolution evolution{planner->getName(), {}};
    for (const std::size_t stop : vertices) {
        planner->params().setParam("max_vertices", std::to_string(stop));
        planner->solve(ob::PlannerTerminationCondition([&] { return interrupted.load(); }));
        TreeStage& stage = evolution.stages.emplace_back();
        stage.vertices = planner->vertices();
        stage.tree = drawnEdges(*planner);
        const auto path = planner->getProblemDefinition()->getSolutionPath();
        if (path == nullptr) continue;
        for (const ob::State* state : path->as<ompl::geometric::PathGeometric>()->getStates()) {
            stage.path.push_back(space.position(state));
        }
        stage.cost = run.judge(*planner).cost;
    }
    return evolution;
}

std::vector<Edge> drawnEdges(const BeliefPlanner& planner) {
    const FlightSpace& space = planner.model().space();
    const auto nodes = planner.tree();
    std::set<std::pair<const ob::State*, const ob::State*>> drawn;
    std::vector<Edge> edges;
    for (const TreeNode& node : nodes) {
        if (node.parent < 0) continue;
        const ob::State* parent = nodes[node.parent].state;
        if (!drawn.emplace(std::minmax(parent, node.state)).second) continue;
        edges.push_back(
            {space.position(parent).cast<float>(), space.position(node.state).cast<float>()});
    }
    return edges;
}

Png drawTreeEvolution(const TopView& map, const std::vector<TreeEvolution>& evolutions,
                      const std::vector<std::size_t>& columns) {
    std::vector<std::vector<TopView>> rows;
    for (const TreeEvolution& evolution : evolutions) {
        auto& row = rows.emplace_back();
        for (const TreeStage& stage : evolution.stages) {
            if (std::find(columns.begin(), columns.end(), stage.vertices) == columns.end()) {
                continue;
            }
            TopView& view = row.emplace_back(map);
            view.title = fmt::format("{}, {} vertices: ", evolution.planner, stage.vertices) +
                         (stage.path.empty() ? "no path yet"
                                             : fmt::format("J {:.2f}, {:.2f} m", stage.cost,
                                                           lengthOf(stage.path)));
            view.trees = {{evolution.planner, kTreeColor, stage.tree}};
            view.paths = {{evolution.planner, kPathColor, {}}};
            for (const Eigen::Vector3d& p : stage.path) {
                view.paths[0].points.push_back({.position = p});
            }
        }
    }
    return drawMaps(rows);
}

}  // namespace photonav
