// SPDX-License-Identifier: BSD-3-Clause
// What tests of planners check of their solutions.
#pragma once

#include <gtest/gtest.h>
#include <ompl/geometric/PathGeometric.h>

#include "planning/fixture.hpp"

namespace photonav::test {

inline ompl::geometric::PathGeometric& solution(const BeliefPlanner& planner) {
    return *planner.getProblemDefinition()->getSolutionPath()->as<ompl::geometric::PathGeometric>();
}

/// Of the solution, by the belief model alone.
inline double replayedCost(const BeliefPlanner& planner) {
    std::vector<const ob::State*> states;
    for (const ob::State* state : solution(planner).getStates()) states.push_back(state);
    return planner.model().evaluate(states).back().cost;
}

inline double sphereClearance(const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(5, 5, 2)).norm() - 2.;
}

inline void expectBeliefsToReplay(const BeliefPlanner& planner) {
    const Audit audit = auditTree(planner);
    EXPECT_GT(audit.nodes, 1U);
    EXPECT_LT(audit.maxCostError, 1e-9);
    EXPECT_LT(audit.maxCovarianceError, 1e-9);
}

}  // namespace photonav::test
