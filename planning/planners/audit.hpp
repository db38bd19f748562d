// SPDX-License-Identifier: BSD-3-Clause
// Trust in a planner: every belief it stores, replayed from the start.
#pragma once

#include "planners/belief_planner.hpp"

namespace photonav {

struct Audit {
    double maxCostError = 0.;        ///< |stored - replayed| / (1 + replayed)
    double maxCovarianceError = 0.;  ///< Frobenius norm, relative to the replayed covariance
    std::size_t nodes = 0;           ///< beliefs replayed
};

/// Replays every node of the planner's tree from its root by BeliefModel::evaluateMotion, plain
/// composition and update, and compares cost and covariance with what the planner stored.
Audit auditTree(const BeliefPlanner& planner);

}  // namespace photonav
