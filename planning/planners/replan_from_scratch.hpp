// SPDX-License-Identifier: BSD-3-Clause
// The simplest way to keep a plan up to date: the baseline of incremental replanning.
#pragma once

#include <functional>
#include <memory>

#include "planners/belief_planner.hpp"

namespace photonav {

/// Effort of all replanning so far.
struct ReplanEffort {
    unsigned plans = 0;
    std::size_t vertices = 0;
    std::size_t views = 0;
    double seconds = 0.;
};

/// Plans anew whenever the map or the start has changed; no vertex and no view of the last plan is
/// used again. This is how Sadat et al. (Feature-rich path planning for robust navigation of MAVs
/// with mono-SLAM, 2014) replan in a growing map, with RRT* as the planner.
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
