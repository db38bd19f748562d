// SPDX-License-Identifier: BSD-3-Clause
#include "problem/plan_result.hpp"

#include "geometry/eigensystem.hpp"
#include "geometry/se3.hpp"
#include "problem/advantage.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

const char* spaceName(StateKind kind) {
    return kind == StateKind::position ? "xyz" : kind == StateKind::positionYaw ? "xyz_yaw" : "se3";
}

json jsonOf(const BeliefPoint& point) {
    return {{"position", vectorJson(point.T_w_b.translation())},
            {"yaw", yawOf(point.T_w_b)},
            {"waypoint", point.isWaypoint},
            {"distance", point.length},
            {"metric_length", point.distance},
            {"trace", point.trace},
            {"trace_before_view", point.traceBefore},
            {"cost", point.cost},
            {"covariance", triangleJson(point.covariance)},
            {"information_trace", point.information.trace()},
            {"min_eigenvalue", std::max(0., eigensystem(point.information).values[0])}};
}

json jsonOf(const EvaluatedPath& path) {
    return {{"planner", path.planner},
            {"cost", path.cost},
            {"length", path.length},
            {"metric_length", path.points.back().distance},
            {"mean_trace", path.meanTrace},
            {"goal_trace", path.goalTrace},
            {"length_share", path.lengthShare},
            {"uncertainty_share", 1. - path.lengthShare}};
}

}  // namespace

json planResult(const Config& config, double kappa, const PlanOutcome& outcome,
                const std::optional<EvaluatedPath>& baseline, bool interrupted) {
    const double tree = outcome.planSeconds - outcome.viewSeconds - outcome.beliefSeconds;
    json result = resultJson("plan", {{"status", interrupted ? "interrupted" : outcome.status()},
                                      {"seed", config.seed},
                                      {"planner", config.planner},
                                      {"information", config.viewModel.name},
                                      {"space", spaceName(config.space)},
                                      {"alpha", outcome.alpha},
                                      {"kappa", kappa},
                                      {"kappa_is_automatic", isAutomatic(config.belief.kappa)},
                                      {"characteristic_length", config.belief.characteristicLength},
                                      {"cost", nullptr},
                                      {"planner_cost", nullptr},
                                      {"length", nullptr},
                                      {"metric_length", nullptr},
                                      {"mean_trace", nullptr},
                                      {"goal_trace", nullptr},
                                      {"vertices", outcome.vertices},
                                      {"iterations", outcome.iterations},
                                      {"views", outcome.views},
                                      {"cache_hits", outcome.cacheHits},
                                      {"second_order_fallbacks", outcome.fallbacks},
                                      {"time",
                                       {{"total_s", nullptr},
                                        {"views_s", outcome.viewSeconds},
                                        {"beliefs_s", outcome.beliefSeconds},
                                        {"tree_s", tree}}},
                                      {"audit",
                                       {{"max_cost_error", outcome.audit.maxCostError},
                                        {"max_covariance_error", outcome.audit.maxCovarianceError},
                                        {"beliefs", outcome.audit.nodes}}},
                                      {"covariance_frame", kCovarianceFrame},
                                      {"path", json::array()}});
    if (baseline) result["baseline"] = jsonOf(*baseline);
    if (!outcome.path) return result;
    result.update(jsonOf(*outcome.path));
    result["planner_cost"] = outcome.plannerCost;
    if (baseline && outcome.isSolved()) {
        const std::string reason = noAdvantage(*outcome.path, *baseline, outcome.alpha);
        if (!reason.empty()) result["verdict"] = reason;
    }
    for (const BeliefPoint& point : outcome.path->points) result["path"].push_back(jsonOf(point));
    return result;
}

}  // namespace photonav
