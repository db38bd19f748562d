// SPDX-License-Identifier: BSD-3-Clause
// The growth of a planner's tree in stages, as in the paper's Fig. 5.
#pragma once

#include <atomic>

#include "problem/planning_problem.hpp"

namespace photonav {

/// A planner's tree and its best path at one stage.
struct TreeStage {
    std::size_t vertices = 0;  ///< number of vertices at this stage
    std::vector<TreeSegment> tree;
    std::vector<Eigen::Vector3d> path;  ///< positions, world frame [m]; empty: no path yet
    double cost = 0.;                   ///< EvaluatedPath::cost of the path
};

struct TreeEvolution {
    std::string planner;
    std::vector<TreeStage> stages;
};

/// Grows a planner in stages. The planner's solve() ends at every stage, where belief_rrt_star
/// searches its roadmap. The result of the last stage therefore differs slightly from the result
/// without stages. An interrupted planner has only the stages before.
/// @param onProgress called while the planner grows, with the time since its first vertex
/// @param vertices numbers of vertices of the stages, in rising order
TreeEvolution growInStages(PlanningProblem& problem, const std::string& planner,
                           const std::vector<std::size_t>& vertices,
                           const std::atomic<bool>& interrupted,
                           const OnPlanProgress& onProgress = {});

/// The edges of a planner's tree. An edge is listed once, also if several beliefs use it.
std::vector<TreeSegment> drawnEdges(const BeliefPlanner& planner);

}  // namespace photonav
