// SPDX-License-Identifier: BSD-3-Clause
// Checks a planner: every belief that it stores is computed again from the start.
#pragma once

#include "planners/belief_planner.hpp"

namespace photonav {

/// Largest errors of the beliefs that a planner stores.
struct Audit {
    double maxCostError = 0.;  ///< |stored - recomputed| / (1 + recomputed)
    /// Frobenius norm of the difference, divided by the norm of the recomputed covariance.
    double maxCovarianceError = 0.;
    std::size_t nodes = 0;  ///< number of beliefs recomputed
};

/// Computes every node of the planner's tree again from its root, with
/// BeliefModel::evaluateMotion(), and compares cost and covariance with the stored ones. Nodes
/// without a covariance are compared by cost only; their recomputed cost is the length of the path.
Audit auditTree(const BeliefPlanner& planner);

}  // namespace photonav
