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
    double cost = 0.;                   ///< of that path, as `plan` evaluates it
};

struct TreeEvolution {
    std::string planner;
    std::vector<TreeStage> stages;
};

/// Grows a planner in stages with these numbers of vertices (in rising order). solve() ends at
/// every stage, and belief_rrt_star then searches its roadmap. Its last stage therefore differs
/// slightly from a problem without stages.
TreeEvolution growInStages(PlanningProblem& problem, const std::string& planner,
                           const std::vector<std::size_t>& vertices,
                           const std::atomic<bool>& interrupted);

/// The motions of the tree, each listed once even if several beliefs use it.
std::vector<TreeSegment> drawnEdges(const BeliefPlanner& planner);

}  // namespace photonav
