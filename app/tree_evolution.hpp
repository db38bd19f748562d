// SPDX-License-Identifier: BSD-3-Clause
// How a planner's tree grows: the paper's Fig. 5.
#pragma once

#include <atomic>

#include "figures.hpp"
#include "plan_run.hpp"

namespace photonav {

/// A planner's tree, and the best path so far, when it had as many vertices.
struct TreeStage {
    std::size_t vertices = 0;
    std::vector<Edge> tree;
    std::vector<Eigen::Vector3d> path;  ///< positions in w; empty: none yet
    double cost = 0.;                   ///< of that path, as `plan` judges it
};

struct TreeEvolution {
    std::string planner;
    std::vector<TreeStage> stages;
};

/// Grows a planner, pausing at each of these numbers of vertices (in rising order). A pause lets it
/// finish: belief_rrt_star searches its roadmap there, so its last stage is not to the digit what
/// it gives in one go.
TreeEvolution growInStages(PlanRun& run, const std::string& planner,
                           const std::vector<std::size_t>& vertices,
                           const std::atomic<bool>& interrupted);

/// The tree's motions between positions, each once however many beliefs flew it.
std::vector<Edge> drawnEdges(const BeliefPlanner& planner);

/// A row of maps per planner, a column per stage: those with `columns` vertices.
/// @param map area, background, start and goal of all of them
Png drawTreeEvolution(const TopView& map, const std::vector<TreeEvolution>& evolutions,
                      const std::vector<std::size_t>& columns);

}  // namespace photonav
