// SPDX-License-Identifier: BSD-3-Clause
// A planning problem: makes planners from a config, and evaluates paths with beliefs.
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

/// A path with its beliefs and cost by the photometric information, also if the planner used
/// another information model.
struct EvaluatedPath {
    std::string planner;
    std::vector<BeliefPoint> points;
    double cost = 0.;         ///< J with the problem's alpha and kappa [m]
    double length = 0.;       ///< length of the position's path [m]
    double lengthShare = 1.;  ///< share of the cost due to length: alpha * distance / cost, where
                              ///< the distance includes turns
    double meanTrace = 0.;    ///< weighted trace, averaged over the distance flown [m^2]
    double goalTrace = 0.;    ///< weighted trace at the end, after the last view [m^2]

    /// The x and y coordinates of the points, world frame [m].
    std::vector<Eigen::Vector2d> fromAbove() const;
};

/// State of a running search.
struct PlanProgress {
    std::size_t vertices = 0;
    double seconds = 0.;    ///< wall-clock time since the search began [s]
    double cost = 0.;       ///< best cost by the planner's own model [m]; infinite: no path yet
    std::size_t views = 0;  ///< number of rendered views
};

using OnPlanProgress = std::function<void(const PlanProgress&)>;

using TreeSegment = std::array<Eigen::Vector3f, 2>;  ///< end points of an edge, world frame [m]

/// Result and effort of planning.
struct PlanOutcome {
    /// None: the goal was not reached, or the path's evaluation was interrupted in a large view.
    std::optional<EvaluatedPath> path;
    /// Cost of the planner's path by its own model [m]; of rrt_star: before it is shortened.
    double plannerCost = 0.;
    double alpha = 0.;  ///< alpha with which the planner searched
    /// Vertices of the tree or roadmap, samples drawn, views rendered, views taken from the cache,
    /// and steps at which compounding of fourth order was replaced by second order.
    std::size_t vertices = 0, iterations = 0, views = 0, cacheHits = 0, fallbacks = 0;
    /// Wall-clock times [s]: of planning in all, and of this for views and for beliefs.
    double planSeconds = 0., viewSeconds = 0., beliefSeconds = 0.;
    std::vector<PlanProgress> progress;
    std::vector<TreeSegment> tree;
    Audit audit;  ///< check of the tree's beliefs and costs, and of the path's cost

    /// Whether a path of finite cost was found. The cost overflows for absurd values of noise or
    /// information.
    bool isSolved() const { return path && std::isfinite(path->cost); }
    /// "done", "failed" (the path's cost is not finite) or "no path".
    std::string status() const { return isSolved() ? "done" : path ? "failed" : "no path"; }
};

/// Start, goal and robot of a config in a world. The problem makes planners and evaluates paths:
///
///     const Config config = loadConfig("config/two_textures.yaml");
///     const World world(config);
///     const PlanOutcome outcome = PlanningProblem(config, world).solve(config.planner);
///
/// Planners and evaluate() share cached views, rendered from the centres of cells of the pose space
/// (InformationField). With Config::quickViews, planners compare paths by cached views of half the
/// size; evaluate(), which planners also use for candidates of the best path, then renders
/// full-size views from the exact poses.
class PlanningProblem {
  public:
    /// @param world must outlive the problem
    /// @param alpha weight of length in the cost; default: the config's planner.alpha. Use
    ///        alphaOf(planner, ...) for the cost that a planner minimises (for rrt_star: length).
    /// @param photometric makes the photometric information model of views
    PlanningProblem(const Config& config, const World& world, std::optional<double> alpha = {},
                    MakeInformationModel photometric = photometricModel);
    /// The same problem with another alpha. Both share the cached views.
    PlanningProblem(const PlanningProblem& other, double alpha);
    PlanningProblem(PlanningProblem&&) = default;
    PlanningProblem(const PlanningProblem&) = delete;  // both would share the planners made here

    /// @throws InputError for a start or goal in collision
    void checkPlaces() const;
    /// @param key key of the config that gives the place
    /// @throws InputError if the place is in collision, which says whether only with unknown cells
    void checkPlace(const std::string& key, const Place& place) const;

    /// Makes a planner and grows it to the config's number of vertices. Gives up after 200 samples
    /// per requested vertex. The path of rrt_star is then shortened by as many changes as
    /// belief_rrt_star tries on its own (planner.shortcut): else its corners, which depend on its
    /// samples, would make the comparison easy.
    /// @param planner one of plannerNames()
    /// @param onProgress called every 50 vertices, every 0.5 s without new vertices, and at the end
    /// @throws Interrupted when it is interrupted inside a large view, without a path so far
    PlanOutcome solve(const std::string& planner,
                      const std::atomic<bool>& interrupted = kNotInterrupted,
                      const OnPlanProgress& onProgress = {});
    /// As above, for a planner of makePlanner(). It may be called again after followMap(): the
    /// planner then continues its search.
    PlanOutcome solve(const std::shared_ptr<BeliefPlanner>& planner,
                      const std::atomic<bool>& interrupted = kNotInterrupted,
                      const OnPlanProgress& onProgress = {});

    /// PlanOutcome::status() and, unless it is "done", the reason: "no path: ...".
    std::string statusOf(const PlanOutcome& outcome) const;

    /// The best path found by local descent.
    /// @param waypoints body poses T_w_b of the path from which the descent starts
    /// @return nothing if the motions between the waypoints are not free
    std::optional<EvaluatedPath> descend(const std::vector<Pose>& waypoints,
                                         const DescentOptions& options,
                                         const std::atomic<bool>& interrupted);

    /// The kappa of all costs [1/m^2]: the config's, or the automatic one. Automatic kappa gives
    /// both terms of the cost the same weight on the path of rrt_star that solve() gives
    /// (on the straight line if rrt_star finds no path): it is the path's distance, including
    /// turns, divided by the charged trace (0 if no trace is charged). It is computed when first
    /// needed and does not change afterwards, also if the map changes.
    /// @param onProgress called while rrt_star grows, as by solve()
    /// @throws Interrupted when it is interrupted inside a large view
    double kappa(const std::atomic<bool>& interrupted = kNotInterrupted,
                 const OnPlanProgress& onProgress = {});

    /// Evaluates a path given by its waypoints.
    /// @param planner name of the planner, stored in the result
    /// @throws Interrupted when it is interrupted inside a large view
    EvaluatedPath evaluate(const std::string& planner, const std::vector<Place>& waypoints,
                           const std::atomic<bool>& interrupted = kNotInterrupted);

    /// The photometric information of the view from a body pose (cached), for heat maps.
    Matrix6 informationAt(const Pose& T_w_b) { return evaluator_->informationAt(T_w_b); }
    /// The covariance at the start before any view, camera frame.
    const Matrix6& initialCovariance() const { return evaluator_->initialCovariance(); }
    /// Whether the clearance at a position of the body is larger than robot.radius.
    bool isFlyable(const Eigen::Vector3d& p_w) const;

    // For programs that run planners themselves.

    const ompl::base::SpaceInformationPtr& spaceInformation() const { return si_; }
    /// Start and goal as an OMPL problem. A goal without heading is given as eight goal states with
    /// different headings.
    ompl::base::ProblemDefinitionPtr definition() const;
    const FlightSpace& space() const { return space_; }
    /// A planner that is set up for this problem.
    /// @param name one of plannerNames()
    /// @param seed default: the config's
    /// @throws std::invalid_argument for another name
    std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                               std::optional<std::uint32_t> seed = {});
    /// Grows a planner's tree to its number of vertices. The path is not evaluated; solve() does
    /// both.
    /// @return the progress every few vertices, and at the end
    std::vector<PlanProgress> grow(BeliefPlanner& planner, const std::atomic<bool>& interrupted,
                                   const OnPlanProgress& onProgress);
    /// As long as the result exists, rendering large views for planners and evaluations ends with
    /// Interrupted when the flag is set.
    [[nodiscard]] InterruptionScope interruptedBy(const std::atomic<bool>& interrupted) {
        return {*interruption_, interrupted};
    }
    /// Applies all changes of World::mapChanged() since the last call to the cached views and to
    /// the planners made here; before, they use the old map. Planners keep what is still valid, and
    /// solve() continues from there. Problems that share cached views: call it for all of them
    /// before any of them solves, or views are rendered twice.
    /// @throws Interrupted when it is interrupted inside a large view; the next call then
    ///        applies the same changes again, so that no planner misses them
    void followMap();
    const Config& config() const { return config_; }
    const World& world() const { return world_; }
    /// The belief model by which paths are evaluated.
    BeliefModel& evaluator();
    /// Evaluates the solution of a planner, that of rrt_star shortened as in solve(), from the
    /// belief that moveRoot() has set, if it has. The planner must have a solution.
    EvaluatedPath evaluate(const BeliefPlanner& planner);
    /// Evaluates a path of any OMPL planner.
    /// @param root belief at the first state; none: the config's
    EvaluatedPath evaluate(const std::string& planner, ompl::geometric::PathGeometric& path,
                           const std::optional<Belief>& root = {});
    /// Clears the cached views. Planners made before must be cleared before they are used again.
    void forgetViews() {
        field_->clear();
        plannersField_->clear();
    }

  private:
    double balancedKappa(const std::atomic<bool>& interrupted, const OnPlanProgress& onProgress);
    BeliefOptions optionsWith(double kappa) const;
    std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                               const std::shared_ptr<BeliefModel>& model,
                                               std::uint32_t seed);
    std::shared_ptr<InformationField> makeField(const std::string& viewModel) const;
    std::shared_ptr<InformationField> makeQuickField() const;
    bool hasQuickViews() const;
    std::shared_ptr<const ViewSource> interruptibleViews() const;
    std::shared_ptr<BeliefModel> plannersModel();
    void judge(const BeliefPlanner& planner, PlanOutcome& outcome);
    ompl::geometric::PathGeometric shortestPath(const BeliefPlanner& planner) const;
    EvaluatedPath evaluate(const std::string& planner,
                           const std::vector<const ompl::base::State*>& path,
                           const std::optional<Belief>& root = {});

    Config config_;  // kappa may be automatic until it is first needed
    const World& world_;
    std::shared_ptr<MapChange> notFollowed_;  // changes of the map since the last followMap()
    /// Points to the flag that interrupts rendering. Shared by all problems over the same views.
    std::shared_ptr<const std::atomic<bool>*> interruption_ =
        std::make_shared<const std::atomic<bool>*>(&kNotInterrupted);
    MakeInformationModel photometric_;
    FlightSpace space_;
    ompl::base::SpaceInformationPtr si_;
    std::shared_ptr<InformationField> field_;             // photometric, for evaluator_
    std::shared_ptr<InformationField> plannersField_;     // for planners
    std::shared_ptr<BeliefModel> evaluator_;              // with kappa = 0 while it is automatic
    std::vector<std::weak_ptr<BeliefPlanner>> planners_;  // made here
};

/// The config with automatic kappa replaced by its value, for several problems that must share
/// kappa although they differ in seed or number of vertices.
/// @param onProgress as of PlanningProblem::kappa()
Config withKappa(Config config, const World& world,
                 const std::atomic<bool>& interrupted = kNotInterrupted,
                 const OnPlanProgress& onProgress = {});

}  // namespace photonav
