// SPDX-License-Identifier: BSD-3-Clause
// A plan that is kept up to date while map and robot change.
#pragma once

#include "config/explore_planner.hpp"
#include "exploration/own_map.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {

/// What an update of the plan changed and cost.
struct PlanUpdate {
    double time = 0.;  ///< of the flight [s]
    UpdateCounts counts;
    std::size_t viewsMarked = 0, viewsRendered = 0;
    double fuseSeconds = 0., clearanceSeconds = 0.;
    double viewSeconds = 0., planSeconds = 0.;  ///< the views are part of planning
    double cost = 0.;    ///< from here to the goal, as planners count [m]; NaN: no path
    double length = 0.;  ///< the same [m]
    double trace = 0.;   ///< of the belief here, weightedTrace() [m^2]
};

/// The problem of a config in the robot's own map, its planner and the path found last:
///
///     update(change):  distances and views follow the map   (World, PlanningProblem::followMap)
///                      what collides or looks otherwise now is repaired      (BeliefPlanner)
///                      root and belief move to where the robot is, the search goes on
///                      beliefs along the best path                           (path())
class OnlinePlanner {
  public:
    /// @param map must outlive it
    OnlinePlanner(const Config& config, const OwnMap& map, const ExplorePlanner& kind,
                  std::uint32_t seed);

    /// Plans from a believed pose, once the map has changed.
    /// @param update all but `time` and `fuseSeconds` is set
    /// @throws RenderingStopped when it is interrupted inside a large view
    void update(const MapChange& change, const UncertainPose& T_c_w, PlanUpdate& update,
                const std::atomic<bool>& interrupted);

    /// From the robot to the goal, with the beliefs predicted; empty: none was found.
    const std::vector<BeliefPoint>& path() const { return path_; }

    /// The present map as it is seen.
    std::shared_ptr<const ViewSource> views() const { return world_.sharedViews(); }
    const World& world() const { return world_; }
    const BeliefPlanner& planner() const { return *planner_; }
    const Config& config() const { return config_; }
    double clearance(const Eigen::Vector3d& p_w) const { return world_.clearance(p_w); }

  private:
    using States = std::vector<std::shared_ptr<ompl::base::State>>;

    std::optional<Eigen::Vector3d> flyableNear(const Eigen::Vector3d& p_w) const;
    UpdateCounts planFrom(const ompl::base::State* state, const Belief& belief,
                          const std::atomic<bool>& interrupted);
    bool solveFrom(const ompl::base::State* state, const Belief& belief,
                   const std::atomic<bool>& interrupted);
    States solution(const std::atomic<bool>& interrupted) const;
    States restOf(const States& plan, const ompl::base::State* state) const;
    void evaluatePath(const Pose& T_w_b, const Matrix6& covariance);

    Config config_;
    World world_;
    PlanningProblem problem_;
    ExplorePlanner kind_;
    std::uint32_t seed_;
    std::shared_ptr<BeliefPlanner> planner_;
    States plan_;  // empty: none was found
    std::vector<BeliefPoint> path_;
};

}  // namespace photonav
