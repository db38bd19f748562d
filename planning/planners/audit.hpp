// SPDX-License-Identifier: BSD-3-Clause
// A check of planners: every belief that a planner stores is computed again from the start.
#pragma once

#include "planners/belief_planner.hpp"

namespace photonav {

struct Audit {
    double maxCostError = 0.;        ///< |stored - recomputed| / (1 + recomputed)
    double maxCovarianceError = 0.;  ///< Frobenius norm, relative to the recomputed covariance
    std::size_t nodes = 0;           ///< beliefs recomputed
};

/// Computes every node of the planner's tree again from its root, by BeliefModel::evaluateMotion(),
/// and compares cost and covariance with those that the planner stored.
Audit auditTree(const BeliefPlanner& planner);

}  // namespace photonav
