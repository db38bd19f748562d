// SPDX-License-Identifier: BSD-3-Clause
// The simplest way to keep a plan up to date, and the baseline to every cleverer one.
#pragma once

#include <functional>
#include <memory>

#include "planners/belief_planner.hpp"

namespace photonav {

/// What replanning took so far.
struct ReplanEffort {
    unsigned plans = 0;
    std::size_t vertices = 0;
    std::size_t views = 0;
    double seconds = 0.;
};

/// Plans anew whenever the map or the start has changed: nothing of the last plan, neither a vertex
/// nor a view, is used again. So Sadat et al. (Feature-rich path planning for robust navigation of
/// MAVs with mono-SLAM, 2014) keep up with a growing map, with RRT* for a planner.
class ReplanFromScratch {
  public:
    /// Makes a planner on the map as it is now, set up for the start as it is now, whose model has
    /// an information field of its own.
    using PlannerFactory = std::function<std::shared_ptr<BeliefPlanner>()>;

    explicit ReplanFromScratch(PlannerFactory makePlanner);

    /// Forgets the last plan and solves the problem as it is now.
    ompl::base::PlannerStatus replan(const ompl::base::PlannerTerminationCondition& ptc);

    /// The planner of the last replan(); null before the first.
    const std::shared_ptr<BeliefPlanner>& planner() const { return planner_; }
    const ReplanEffort& effort() const { return effort_; }

  private:
    PlannerFactory makePlanner_;
    std::shared_ptr<BeliefPlanner> planner_;
    ReplanEffort effort_;
};

}  // namespace photonav
