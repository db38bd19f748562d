// SPDX-License-Identifier: BSD-3-Clause
// From start to goal with one of our planners: what tutorials 5 to 7 share.
#pragma once

#include <ompl/base/ScopedState.h>
#include <ompl/geometric/PathGeometric.h>

#include <memory>
#include <string>
#include <vector>

#include "belief_rrt_star.hpp"
#include "perception_rrt_star.hpp"

namespace planning_problem {

using namespace photonav;

struct Problem {
    FlightSpace space;
    Eigen::Vector3d start, goal;  // [m]
};

//! [planner]
/// A planner that stops with so many vertices.
/// @param labels beliefs kept per vertex by belief_rrt_star
inline std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name, const Problem& problem,
                                                  const std::shared_ptr<InformationField>& field,
                                                  BeliefOptions beliefs, unsigned vertices,
                                                  unsigned labels = 5) {
    const auto anywhere = [](const Eigen::Vector3d&) { return 1.; };  // clearance: no obstacles
    const auto si = makeSpaceInformation(problem.space, anywhere, 0.3);
    if (name == "rrt_star") beliefs.alpha = 1.;  // only length counts
    const auto model = std::make_shared<BeliefModel>(problem.space, field, beliefs);
    const GrowthOptions growth{.maxVertices = vertices};
    std::shared_ptr<BeliefPlanner> planner;
    if (name == "belief_rrt_star") {
        planner =
            std::make_shared<BeliefRRTstar>(si, model, SearchOptions{.labels = labels}, growth);
    } else {
        planner = std::make_shared<PerceptionRRTstar>(si, model, growth);
    }
    ompl::base::ScopedState<> start(si);
    ompl::base::ScopedState<> goal(si);
    problem.space.setState(start.get(), problem.start, 0.);
    problem.space.setState(goal.get(), problem.goal, 0.);
    const auto definition = std::make_shared<ompl::base::ProblemDefinition>(si);
    definition->setStartAndGoalStates(start, goal);
    planner->setProblemDefinition(definition);
    planner->setup();
    return planner;
}
//! [planner]

//! [plan]
/// Plans, and lets one judge say what the path is worth, whoever found it.
inline std::vector<BeliefPoint> plan(BeliefPlanner& planner, BeliefModel& judge) {
    planner.solve(ompl::base::plannerNonTerminatingCondition());
    const auto path = planner.getProblemDefinition()->getSolutionPath();
    std::vector<const ompl::base::State*> states;
    for (const ompl::base::State* state : path->as<ompl::geometric::PathGeometric>()->getStates()) {
        states.push_back(state);
    }
    return judge.evaluate(states);
}
//! [plan]

inline double meanTrace(const std::vector<BeliefPoint>& path) {
    double integral = 0.;
    for (std::size_t i = 1; i < path.size(); ++i) {
        integral += 0.5 * (path[i].distance - path[i - 1].distance) *
                    (path[i - 1].trace + path[i].traceBefore);
    }
    return integral / path.back().distance;
}

/// The way from above.
inline std::vector<Eigen::Vector2d> route(const std::vector<BeliefPoint>& path) {
    std::vector<Eigen::Vector2d> points;
    for (const BeliefPoint& point : path) points.push_back(point.T_w_b.translation().head<2>());
    return points;
}

/// What lies below `area`, seen from so high above that perspective does not matter: first row at
/// the largest y. Grey values in [0, 1].
inline ImageF fromAbove(const ViewSource& floor, const Eigen::AlignedBox2d& area,
                        unsigned pixelsPerMetre) {
    const double height = 500.;
    Pose T_w_c = Pose::Identity();  // image right is world x, image down is world -y
    T_w_c.linear() = Eigen::Vector3d(1., -1., -1.).asDiagonal();
    T_w_c.translation() << area.center(), height;
    const Eigen::Vector2d size = area.sizes();
    View view;
    floor.render(makeCamera(static_cast<unsigned>(size.x() * pixelsPerMetre),
                            static_cast<unsigned>(size.y() * pixelsPerMetre),
                            2. * std::atan(0.5 * size.x() / height)),
                 T_w_c.inverse(), view);
    return view.intensity;
}

}  // namespace planning_problem
