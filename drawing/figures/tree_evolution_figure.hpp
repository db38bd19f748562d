// SPDX-License-Identifier: BSD-3-Clause
// A figure of the growth of planners' trees, as the paper's Fig. 5.
#pragma once

#include "figures/top_view.hpp"
#include "problem/tree_evolution.hpp"

namespace photonav {

/// One row of maps per planner and one column per stage.
/// @param map gives area, background, start and goal of all maps
/// @param columns numbers of vertices of the stages to draw
Figure treeEvolutionFigure(const TopView& map, const std::vector<TreeEvolution>& evolutions,
                           const std::vector<std::size_t>& columns);

}  // namespace photonav
