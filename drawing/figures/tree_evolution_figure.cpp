// SPDX-License-Identifier: BSD-3-Clause
#include "figures/tree_evolution_figure.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace photonav {
namespace {

double lengthOf(const std::vector<Eigen::Vector3d>& path) {
    double length = 0.;
    for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
    return length;
}

}  // namespace

Figure treeEvolutionFigure(const TopView& map, const std::vector<TreeEvolution>& evolutions,
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
            view.paths = {{evolution.planner, plannerColor(evolution.planner), {}}};
            for (const Eigen::Vector3d& p : stage.path) {
                view.paths[0].points.push_back({.position = p});
            }
        }
    }
    return mapsFigure(rows);
}

}  // namespace photonav
