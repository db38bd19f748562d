// SPDX-License-Identifier: BSD-3-Clause
// Replanning without reuse of the last plan: the baseline of incremental replanning.
#pragma once

#include <functional>
#include <memory>

#include "planners/belief_planner.hpp"

namespace photonav {

/// Effort of all plans so far.
struct ReplanEffort {
    unsigned plans = 0;        ///< number of plans
    std::size_t vertices = 0;  ///< sum over the plans
    std::size_t views = 0;     ///< number of views evaluated
    double seconds = 0.;       ///< wall-clock time [s]
};

/// Plans anew whenever the map or the start has changed, without any vertex or view of the last
/// plan. Sadat et al. (Feature-rich path planning for robust navigation of MAVs with mono-SLAM,
/// 2014) replan in a growing map in this way, with RRT* as the planner.
class ReplanFromScratch {
  public:
    /// Makes a planner for the present map and start, whose model has an information field of its
    /// own.
    using PlannerFactory = std::function<std::shared_ptr<BeliefPlanner>()>;

    explicit ReplanFromScratch(PlannerFactory makePlanner);

    /// Drops the last plan and solves the present problem.
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
