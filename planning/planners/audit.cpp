// SPDX-License-Identifier: BSD-3-Clause
#include "planners/audit.hpp"

#include <cmath>

namespace photonav {
namespace {

/// The larger error. NaN is larger than any number.
double largerError(double a, double b) { return std::isnan(a) || a >= b ? a : b; }

}  // namespace

Audit auditTree(const BeliefPlanner& planner) {
    BeliefModel& model = planner.model();
    const auto nodes = planner.tree();
    std::vector<BeliefPoint> replayed;
    replayed.reserve(nodes.size());
    Audit audit;
    for (const TreeNode& node : nodes) {
        if (!node.covariance) {  // a planner without beliefs: its cost is the path flown
            BeliefPoint point{};
            if (planner.movedRoot()) point.cost = planner.movedRoot()->cost;
            if (node.parent >= 0) {
                const double way = model.motion(nodes[node.parent].state, node.state).length;
                point.cost = replayed[node.parent].cost + way;
            }
            replayed.push_back(point);
        } else if (node.parent < 0) {
            replayed.push_back(model.evaluate({node.state}, planner.movedRoot()).front());
        } else {
            std::vector<BeliefPoint> way{replayed[node.parent]};
            model.evaluateMotion(nodes[node.parent].state, node.state, way);
            replayed.push_back(way.back());
        }
        const BeliefPoint& truth = replayed.back();
        const double costError = std::abs(node.cost - truth.cost) / (1. + truth.cost);
        audit.maxCostError = largerError(audit.maxCostError, costError);
        if (node.covariance) {
            const double error = (*node.covariance - truth.covariance).norm() /
                                 std::max(truth.covariance.norm(), 1e-300);
            audit.maxCovarianceError = largerError(audit.maxCovarianceError, error);
        }
        ++audit.nodes;
    }
    return audit;
}

}  // namespace photonav
