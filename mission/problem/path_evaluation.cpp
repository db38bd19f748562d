// SPDX-License-Identifier: BSD-3-Clause
// What a path costs in a planning problem, and the kappa of that cost.
#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathGeometric.h>

#include <algorithm>

#include "geometry/se3.hpp"
#include "planners/path_descent.hpp"
#include "planners/planner_traits.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr double kMostKappa = 1e12;  // as in a config

/// The uncertainty in the cost of a path: the integral of the trace, or its sum over the vertices.
double chargeOf(const std::vector<BeliefPoint>& points, CostRule rule) {
    double charge = 0.;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const BeliefPoint &last = points[i - 1], &next = points[i];
        charge += rule == CostRule::perVertex
                      ? next.trace
                      : 0.5 * (next.distance - last.distance) * (last.trace + next.traceBefore);
    }
    return charge;
}

}  // namespace

std::vector<Eigen::Vector2d> EvaluatedPath::fromAbove() const {
    std::vector<Eigen::Vector2d> positions;
    positions.reserve(points.size());
    for (const BeliefPoint& point : points) {
        positions.emplace_back(point.T_w_b.translation().head<2>());
    }
    return positions;
}

std::optional<EvaluatedPath> PlanningProblem::descend(const std::vector<Pose>& waypoints,
                                                      const DescentOptions& options,
                                                      const std::atomic<bool>& interrupted) {
    ompl::geometric::PathGeometric path(si_);
    ob::ScopedState<> state(si_);
    for (const Pose& T_w_b : waypoints) {
        space_.setState(state.get(), T_w_b.translation(), yawOf(T_w_b));
        path.append(state.get());
    }
    if (waypoints.empty() || !path.check()) return std::nullopt;
    kappa(interrupted);
    PathDescent descent(si_, evaluator_, options);
    descent.begin({path.getStates().begin(), path.getStates().end()});
    descent.descend(ob::PlannerTerminationCondition([&] { return interrupted.load(); }));
    return evaluate("descent", descent.path());
}

EvaluatedPath PlanningProblem::evaluate(const BeliefPlanner& planner) {
    const PlannerTraits* traits = findPlanner(planner.getName());
    if (traits != nullptr && !traits->usesViews) {
        ompl::geometric::PathGeometric shortest = shortestPath(planner);
        return evaluate(planner.getName(), shortest, planner.movedRoot());
    }
    const auto& path = planner.bestPath();
    return evaluate(planner.getName(), std::vector<const ob::State*>(path.begin(), path.end()),
                    planner.movedRoot());
}

EvaluatedPath PlanningProblem::evaluate(const std::string& planner,
                                        ompl::geometric::PathGeometric& path,
                                        const std::optional<Belief>& root) {
    const auto& states = path.getStates();
    return evaluate(planner, std::vector<const ob::State*>(states.begin(), states.end()), root);
}

EvaluatedPath PlanningProblem::evaluate(const std::string& planner,
                                        const std::vector<Place>& waypoints,
                                        const std::atomic<bool>& interrupted) {
    kappa(interrupted);
    const InterruptionScope scope = interruptedBy(interrupted);
    std::vector<ob::ScopedState<>> states;
    std::vector<const ob::State*> pointers;
    states.reserve(waypoints.size());
    pointers.reserve(waypoints.size());
    for (const Place& place : waypoints) {
        pointers.push_back(states.emplace_back(si_).get());
        space_.setState(states.back().get(), place.position, place.yaw.value_or(0.));
    }
    return evaluate(planner, pointers);
}

EvaluatedPath PlanningProblem::evaluate(const std::string& planner,
                                        const std::vector<const ob::State*>& path,
                                        const std::optional<Belief>& root) {
    EvaluatedPath evaluated;
    evaluated.planner = planner;
    evaluated.points = evaluator().evaluate(path, root);
    const double integral = chargeOf(evaluated.points, CostRule::integral);
    const BeliefPoint& goal = evaluated.points.back();
    evaluated.cost = goal.cost;
    const double added = goal.cost - evaluated.points.front().cost;
    if (added > 0.) evaluated.lengthShare = config_.belief.alpha * goal.distance / added;
    evaluated.length = goal.length;
    evaluated.meanTrace = goal.distance > 0. ? integral / goal.distance : goal.trace;
    evaluated.goalTrace = goal.trace;
    return evaluated;
}

Config withKappa(Config config, const World& world, const std::atomic<bool>& interrupted,
                 const OnPlanProgress& onProgress) {
    if (isAutomatic(config.belief.kappa)) {
        config.belief.kappa = PlanningProblem(config, world).kappa(interrupted, onProgress);
    }
    return config;
}

BeliefModel& PlanningProblem::evaluator() {
    kappa();
    return *evaluator_;
}

double PlanningProblem::kappa(const std::atomic<bool>& interrupted,
                              const OnPlanProgress& onProgress) {
    if (isAutomatic(config_.belief.kappa)) {
        config_.belief.kappa = balancedKappa(interrupted, onProgress);
        evaluator_ =
            std::make_shared<BeliefModel>(space_, field_, optionsWith(config_.belief.kappa));
    }
    return config_.belief.kappa;
}

double PlanningProblem::balancedKappa(const std::atomic<bool>& interrupted,
                                      const OnPlanProgress& onProgress) {
    const InterruptionScope scope = interruptedBy(interrupted);
    const auto planner = makePlanner("rrt_star", evaluator_, config_.seed);
    grow(*planner, interrupted, onProgress);
    ompl::geometric::PathGeometric path(si_);
    if (planner->bestPath().empty()) {
        const auto line = definition();
        path.append(line->getStartState(0));
        path.append(line->getGoal()->as<ob::GoalStates>()->getState(0));
    } else {
        path = shortestPath(*planner);
    }
    const auto& states = path.getStates();
    const std::vector<BeliefPoint> points = evaluator_->evaluate({states.begin(), states.end()});
    const double charged = chargeOf(points, config_.belief.cost);
    return charged > 0. ? std::min(points.back().distance / charged, kMostKappa) : 0.;
}

}  // namespace photonav
