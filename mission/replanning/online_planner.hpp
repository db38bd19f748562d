// SPDX-License-Identifier: BSD-3-Clause
// Online planning: updates a plan while the map grows and the robot moves.
#pragma once

#include <mutex>

#include "config/explore_planner.hpp"
#include "io/stopwatch.hpp"
#include "onlinemap/online_map.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {

/// Changes, wall-clock times and result of an update of the plan.
struct PlanUpdate {
    double time = 0.;                                ///< time in the flight [s]
    UpdateCounts counts;                             ///< changes of the tree or roadmap
    std::size_t viewsMarked = 0, viewsRendered = 0;  ///< cached views: outdated, rendered
    double fuseSeconds = 0., clearanceSeconds = 0.;  ///< wall-clock time [s]
    double viewSeconds = 0., planSeconds = 0.;  ///< wall-clock time [s]; planning includes views
    /// Cost of the path from the robot to the goal, of a robot that knows its place in the map as
    /// explore.initial says [m]; NaN: no path.
    double cost = 0.;
    double length = 0.;  ///< length of the path from the robot to the goal [m]; NaN: no path
    double trace = 0.;   ///< weightedTrace() of the robot's present belief [m^2]
    bool isEndedByClock = false;  ///< PlanningLimits::seconds ended the improvement of the plan
};

/// The limits of an update, which may end it before its work is done.
struct PlanningLimits {
    const std::atomic<bool>& interrupted;  ///< ends it at once when it becomes true
    /// Wall-clock time of planning after which a path is not improved any more [s]. The search for
    /// a first path goes on.
    double seconds = kInfinity;
};

/// The planning problem of a config in the robot's own map, its planner and its best path.
///
///     update(change):  update clearance and cached views    (World, PlanningProblem::followMap)
///                      invalidate and repair edges and views that the change affects
///                                                                            (BeliefPlanner)
///                      move the root to the robot's pose, continue the search
///                      evaluate beliefs along the best path                  (path())
class OnlinePlanner {
  public:
    /// @param map must outlive the planner
    /// @param kind planner, headings and replanning policy
    OnlinePlanner(const Config& config, const OnlineMap& map, const ExplorePlanner& kind,
                  std::uint32_t seed);

    /// Updates the plan from the believed pose after a change of the map.
    /// @param change everything that changed in map and obstacles since the last call
    /// @param T_c_w the robot's present belief
    /// @param update receives all values except `time` and `fuseSeconds`
    /// @throws Interrupted when it is interrupted inside a large view
    void update(const MapChange& change, const UncertainPose& T_c_w, PlanUpdate& update,
                const PlanningLimits& limits);

    /// The path from the robot to the goal with predicted beliefs. If the map shows no way to the
    /// goal: to a place near the goal that can be reached without a long way, facing the goal. From
    /// there the camera may see that an obstacle is none. (Depth of a stereo pair is poor far
    /// away.) Empty if the robot is there and looks at the goal, or if an obstacle was seen on a
    /// plan that is made once.
    const std::vector<BeliefPoint>& path() const { return path_; }
    double kappa() { return problem_.kappa(); }
    bool reachesGoal() const { return reachesGoal_; }  ///< whether path() ends at the goal

    /// Renders views of the present map.
    std::shared_ptr<const ViewSource> views() const { return world_.sharedViews(); }
    const World& world() const { return world_; }
    const BeliefPlanner& planner() const { return *planner_; }
    const Config& config() const { return config_; }
    double clearance(const Eigen::Vector3d& p_w) const { return world_.clearance(p_w); }
    /// clearance() for another thread than update()'s. It waits while update() changes the
    /// clearances, which takes milliseconds; not while update() plans.
    double clearanceBeside(const Eigen::Vector3d& p_w) const {
        const std::lock_guard lock(worldMutex_);
        return world_.clearance(p_w);
    }

  private:
    using States = std::vector<std::shared_ptr<ompl::base::State>>;
    class Limits;

    bool isWayOut(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const;
    std::optional<Eigen::Vector3d> flyableNear(const Eigen::Vector3d& p_w) const;
    UpdateCounts planFrom(const ompl::base::State* state, const Belief& belief,
                          const Limits& limits);
    bool solveFrom(const ompl::base::State* state, const Belief& belief, const Limits& limits);
    States solution(const Limits& limits) const;
    States approach() const;
    States wayNearGoal() const;
    States facingGoal(States plan) const;
    States withHeadings(States plan) const;
    States restOf(const States& plan, const ompl::base::State* state) const;
    std::vector<BeliefPoint> pathFrom(const Pose& T_w_b, const Matrix6& covariance);
    void evaluatePath(const Pose& T_w_b, const Matrix6& covariance);

    Config config_;
    mutable std::mutex worldMutex_;  // of world_ while it changes, for clearanceBeside()
    World world_;
    PlanningProblem problem_;
    ExplorePlanner kind_;
    std::uint32_t seed_;
    std::shared_ptr<BeliefPlanner> planner_;
    States plan_;  // empty if no path was found
    bool reachesGoal_ = false;
    bool hasPlanned_ = false;
    int failed_ = 0;  // updates in a row without a way to the goal
    std::vector<BeliefPoint> path_;
};

}  // namespace photonav
