// SPDX-License-Identifier: BSD-3-Clause
// A config becomes a planner, a planner becomes a path with beliefs.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "audit.hpp"
#include "config.hpp"
#include "world.hpp"

namespace photonav {

/// A path as it was judged: by the photometric beliefs along it, whoever planned it.
struct JudgedPath {
    std::string planner;
    std::vector<BeliefPoint> points;
    double cost = 0.;       ///< with the config's alpha and kappa
    double length = 0.;     ///< of the positions [m]
    double meanTrace = 0.;  ///< integral of the trace over the way flown, by its length
    double goalTrace = 0.;  ///< after the last view
};

/// What planning took and gave.
struct PlanOutcome {
    std::optional<JudgedPath> path;  ///< none: the goal was not reached
    double plannerCost = 0.;         ///< of the path, as the planner itself sees it
    double alpha = 0.;
    std::size_t vertices = 0, iterations = 0, views = 0, cacheHits = 0, fallbacks = 0;
    double planSeconds = 0., viewSeconds = 0., beliefSeconds = 0.;
    std::vector<ReportProgress> progress;
    std::vector<Edge> tree;  ///< of positions, in w [m]
    Audit audit;             ///< of the tree, and of the path's cost
};

/// Start, goal and robot of a config in a world, and the planners that solve them.
class PlanRun {
  public:
    PlanRun(const Config& config, const World& world);

    /// @throws InputError for a start or goal in collision
    void checkPlaces() const;

    /// Grows the planner of this name until it has the config's number of vertices.
    /// @param onProgress called now and then while planning
    PlanOutcome solve(const std::string& planner, const std::atomic<bool>& interrupted,
                      const std::function<void(const ReportProgress&)>& onProgress);

    /// "done", or why there is no path.
    std::string statusOf(const PlanOutcome& outcome) const;
    /// For a tree of this size that does not reach the goal.
    std::string reasonForNoPath(std::size_t vertices, std::size_t iterations) const;

    /// The best path that descent from these waypoints (of the body) finds.
    /// @return nothing if the way along them is not free
    std::optional<JudgedPath> descend(const std::vector<Pose>& waypoints,
                                      const DescentOptions& options,
                                      const std::atomic<bool>& interrupted);

    /// A path given by its waypoints, judged like one that was found.
    JudgedPath judge(const std::string& planner, const std::vector<Place>& waypoints);

    /// The information of a view from here, remembered; for heat maps.
    const Matrix6& informationAt(const Pose& T_w_b) { return judge_->informationAt(T_w_b); }
    /// The belief at the start, camera frame.
    Belief root() const { return judge_->root(); }
    bool isFlyable(const Eigen::Vector3d& p_w) const;

    // For those who run planners themselves.

    const ompl::base::SpaceInformationPtr& spaceInformation() const { return si_; }
    /// Start and goal.
    ompl::base::ProblemDefinitionPtr definition() const;
    /// A planner that is set up for it.
    std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name) const;
    /// The solution of a planner that has one.
    JudgedPath judge(const BeliefPlanner& planner);
    /// Makes the next views new ones; planners that are not cleared must not be used again.
    void forgetViews() {
        field_->clear();
        plannersField_->clear();
    }

  private:
    void checkPlace(const std::string& key, const Place& place) const;
    std::shared_ptr<InformationField> makeField(const std::string& viewModel) const;
    std::shared_ptr<BeliefModel> makeModel(std::shared_ptr<InformationField> field,
                                           double alpha) const;
    JudgedPath judge(const std::string& planner, const std::vector<const ompl::base::State*>& path);

    const Config& config_;
    const World& world_;
    FlightSpace space_;
    ompl::base::SpaceInformationPtr si_;
    std::shared_ptr<InformationField> field_;          // photometric: what judges
    std::shared_ptr<InformationField> plannersField_;  // what the planner goes by
    std::shared_ptr<BeliefModel> judge_;
};

}  // namespace photonav
