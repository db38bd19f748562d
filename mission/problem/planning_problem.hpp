// SPDX-License-Identifier: BSD-3-Clause
// From a config to a planner, and to a path with beliefs.
#pragma once

#include <ompl/geometric/PathGeometric.h>

#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>

#include "config/config.hpp"
#include "planners/audit.hpp"
#include "problem/interruption_scope.hpp"
#include "problem/world.hpp"

namespace photonav {

/// A path and its photometric beliefs, whatever information model its planner used.
struct EvaluatedPath {
    std::string planner;
    std::vector<BeliefPoint> points;
    double cost = 0.;         ///< with the problem's alpha, and the config's kappa
    double length = 0.;       ///< of the positions [m]
    double lengthShare = 1.;  ///< of the cost: alpha times the length, turns counted
    double meanTrace = 0.;    ///< integral of the trace over the distance flown, divided by it
    double goalTrace = 0.;    ///< after the last view

    /// Positions of the points in x and y of w [m].
    std::vector<Eigen::Vector2d> fromAbove() const;
};

/// State of the search when its best cost changed (and at its end).
struct PlanProgress {
    std::size_t vertices = 0;
    double seconds = 0.;
    double cost = 0.;  ///< the planner's own; infinite: no path yet
    std::size_t views = 0;
};

using OnPlanProgress = std::function<void(const PlanProgress&)>;

using TreeSegment = std::array<Eigen::Vector3f, 2>;  ///< end points in w [m]

/// Result and effort of planning.
struct PlanOutcome {
    std::optional<EvaluatedPath> path;  ///< none: the goal was not reached
    double plannerCost = 0.;            ///< of the path, by the planner's own model
    double alpha = 0.;
    std::size_t vertices = 0, iterations = 0, views = 0, cacheHits = 0, fallbacks = 0;
    double planSeconds = 0., viewSeconds = 0., beliefSeconds = 0.;
    std::vector<PlanProgress> progress;
    std::vector<TreeSegment> tree;
    Audit audit;  ///< of the tree, and of the path's cost

    /// A path whose cost is a number: where noise or information are absurd, it overflows.
    bool isSolved() const { return path && std::isfinite(path->cost); }
    /// In a word or two: "done", "failed" or "no path".
    std::string status() const { return isSolved() ? "done" : path ? "failed" : "no path"; }
};

/// Start, goal and robot of a config in a world, and the planners that solve them:
///
///     const Config config = loadConfig("config/two_textures.yaml");
///     const World world(config);
///     const PlanOutcome outcome = PlanningProblem(config, world).solve(config.planner);
///
/// Planners and evaluate() share views from the centres of cells (InformationField). With
/// Config::quickViews, planners rank paths by views of half the size there, and evaluate(), which
/// also judges for planners what may be the best path, uses whole views from the exact poses.
class PlanningProblem {
  public:
    /// @param world must outlive it
    /// @param alpha of the cost; default: the config's, whatever its planner. The cost that the
    ///        planner of a config minimises, for rrt_star the length, has alphaOf(its name, ...).
    /// @param photometric makes the information of views, in place of photometricModel()
    PlanningProblem(const Config& config, const World& world, std::optional<double> alpha = {},
                    MakeInformationModel photometric = photometricModel);
    /// The same problem with another trade-off, over the same views.
    PlanningProblem(const PlanningProblem& other, double alpha);
    PlanningProblem(PlanningProblem&&) = default;
    PlanningProblem(const PlanningProblem&) = delete;  // both would share the planners made here

    /// @throws InputError for a start or goal in collision
    void checkPlaces() const;

    /// Grows the planner of this name until it has the config's number of vertices.
    /// @throws RenderingStopped when it is interrupted inside a large view, without a path so far
    /// @param onProgress called now and then while planning
    PlanOutcome solve(const std::string& planner,
                      const std::atomic<bool>& interrupted = kNotInterrupted,
                      const OnPlanProgress& onProgress = {});
    /// Grows a planner of makePlanner() as far as its parameters allow: a new one, or once more one
    /// after followMap().
    PlanOutcome solve(const std::shared_ptr<BeliefPlanner>& planner,
                      const std::atomic<bool>& interrupted = kNotInterrupted,
                      const OnPlanProgress& onProgress = {});

    /// The status of an outcome and, unless it is done, the reason: "no path: ...".
    std::string statusOf(const PlanOutcome& outcome) const;

    /// The best path found by descent from these waypoints (of the body).
    /// @return nothing if the motions between them are not free
    std::optional<EvaluatedPath> descend(const std::vector<Pose>& waypoints,
                                         const DescentOptions& options,
                                         const std::atomic<bool>& interrupted);

    /// The kappa of all costs: the config's, or, where that is automatic, the one with which both
    /// terms weigh the same on the path of rrt_star with the seed of the config, or on the straight
    /// line where it finds none: the length of the path, turns counted, by its charged trace (0
    /// where nothing is charged). Chosen when it is needed first, and the same from then on,
    /// whatever becomes of the map.
    /// @throws RenderingStopped when it is interrupted inside a large view
    double kappa(const std::atomic<bool>& interrupted = kNotInterrupted);

    /// Evaluates a path given by its waypoints.
    /// @throws RenderingStopped when it is interrupted inside a large view
    EvaluatedPath evaluate(const std::string& planner, const std::vector<Place>& waypoints,
                           const std::atomic<bool>& interrupted = kNotInterrupted);

    /// The information of the view from a body pose, cached; for heat maps.
    Matrix6 informationAt(const Pose& T_w_b) { return evaluator_->informationAt(T_w_b); }
    /// The covariance at the start before any view, camera frame.
    const Matrix6& initialCovariance() const { return evaluator_->initialCovariance(); }
    bool isFlyable(const Eigen::Vector3d& p_w) const;

    // For programs that run planners themselves.

    const ompl::base::SpaceInformationPtr& spaceInformation() const { return si_; }
    /// Start and goal.
    ompl::base::ProblemDefinitionPtr definition() const;
    const FlightSpace& space() const { return space_; }
    /// A planner that is set up for it.
    /// @param name one of plannerNames() @throws std::invalid_argument for any other
    /// @param seed default: the config's
    std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                               std::optional<std::uint32_t> seed = {});
    /// Lets a flag end the large views of planners and of evaluations, which throw
    /// RenderingStopped.
    [[nodiscard]] InterruptionScope interruptedBy(const std::atomic<bool>& interrupted) {
        return {*interruption_, interrupted};
    }
    /// Updates the cached views and the planners made here by all changes of World::mapChanged()
    /// since the last call; until then they are those of the map before. Planners keep what is
    /// still valid: solve() goes on from there. Call it for every problem in the world, one by one.
    void followMap();
    const Config& config() const { return config_; }
    const World& world() const { return world_; }
    /// The model that paths are evaluated by.
    BeliefModel& evaluator();
    /// Evaluates the solution of a planner that has one.
    EvaluatedPath evaluate(const BeliefPlanner& planner);
    /// Evaluates a path of any planner of OMPL.
    EvaluatedPath evaluate(const std::string& planner, ompl::geometric::PathGeometric& path);
    /// Clears the cached views. Planners made before must be cleared, or not be used again.
    void forgetViews() {
        field_->clear();
        plannersField_->clear();
    }

  private:
    void checkPlace(const std::string& key, const Place& place) const;
    double balancedKappa(const std::atomic<bool>& interrupted);
    BeliefOptions optionsWith(double kappa) const;
    std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                               const std::shared_ptr<BeliefModel>& model,
                                               std::uint32_t seed);
    std::shared_ptr<InformationField> makeField(const std::string& viewModel) const;
    std::shared_ptr<InformationField> makeQuickField() const;
    bool hasQuickViews() const;
    std::shared_ptr<const ViewSource> interruptibleViews() const;
    std::shared_ptr<BeliefModel> plannersModel();
    EvaluatedPath evaluate(const std::string& planner,
                           const std::vector<const ompl::base::State*>& path);

    Config config_;  // its kappa may be automatic until it is needed
    const World& world_;
    std::shared_ptr<MapChange> notFollowed_;  // changes of its map
    /// What ends the rendering of views; of all problems over the same views.
    std::shared_ptr<const std::atomic<bool>*> interruption_ =
        std::make_shared<const std::atomic<bool>*>(&kNotInterrupted);
    MakeInformationModel photometric_;
    FlightSpace space_;
    ompl::base::SpaceInformationPtr si_;
    std::shared_ptr<InformationField> field_;             // photometric, of evaluator_
    std::shared_ptr<InformationField> plannersField_;     // of the planner
    std::shared_ptr<BeliefModel> evaluator_;              // without costs while kappa is automatic
    std::vector<std::weak_ptr<BeliefPlanner>> planners_;  // made here
};

/// The config with a number as kappa, for problems that have to share it: those of other seeds, or
/// with other numbers of vertices.
Config withKappa(Config config, const World& world,
                 const std::atomic<bool>& interrupted = kNotInterrupted);

}  // namespace photonav
