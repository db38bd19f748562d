// SPDX-License-Identifier: BSD-3-Clause
// How a planner's tree grows: the paper's Fig. 5.
#pragma once

#include "figures/top_view.hpp"
#include "problem/tree_evolution.hpp"

namespace photonav {

/// A row of maps per planner, a column per stage: those with `columns` vertices.
/// @param map area, background, start and goal of all of them
Figure treeEvolutionFigure(const TopView& map, const std::vector<TreeEvolution>& evolutions,
                           const std::vector<std::size_t>& columns);

}  // namespace photonav
