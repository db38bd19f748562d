// SPDX-License-Identifier: BSD-3-Clause
// How a planner's tree grows: the paper's Fig. 5.
#pragma once

#include <atomic>

#include "problem/planning_problem.hpp"

namespace photonav {

/// A planner's tree, and the best path so far, when it had as many vertices.
struct TreeStage {
    std::size_t vertices = 0;
    std::vector<TreeSegment> tree;
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
TreeEvolution growInStages(PlanningProblem& run, const std::string& planner,
                           const std::vector<std::size_t>& vertices,
                           const std::atomic<bool>& interrupted);

/// The tree's motions between positions, each once however many beliefs flew it.
std::vector<TreeSegment> drawnEdges(const BeliefPlanner& planner);

}  // namespace photonav
