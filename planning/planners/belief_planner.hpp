// SPDX-License-Identifier: BSD-3-Clause
// The base class of the planners: it grows a set of vertices by sampling, and implements OMPL's
// planner interface.
#pragma once

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/Planner.h>
#include <ompl/datastructures/NearestNeighbors.h>
#include <ompl/util/RandomNumbers.h>

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "belief/belief.hpp"
#include "geometry/constants.hpp"
#include "planners/changed_space.hpp"
#include "planners/updated_space.hpp"
#include "planners/vertex.hpp"

namespace photonav {

struct GrowthOptions {
    /// Longest motion to a new vertex, metric of the space [m]; 0: a fifth of its maximum extent.
    double range = 0.;
    double goalBias = 0.05;     ///< share of samples at goals, until every goal state is a vertex
    double rewireFactor = 1.1;  ///< factor on the connection radius of Karaman and Frazzoli 2011
    std::uint32_t seed = 1;     ///< seed of the samples
    /// Largest number of vertices. Growth ends when it is reached; 0: no limit. A graph without a
    /// goal, which may have become free, gets up to 20 more; where a change of the map has blocked
    /// the best path, belief_rrt_star adds some as well, up to as many again in all.
    unsigned maxVertices = 0;
    /// Largest number of samples since the map or the root last changed; 0: no limit.
    std::size_t maxIterations = 0;
    /// Duration of every solve() [s], for callers of OMPL's interface (SimpleSetup, benchmarks),
    /// whose termination condition does not tell the planner how long it may take; 0: not known.
    double timeLimit = 0.;
    /// Distance beyond which obstacles do not affect a motion [m]: the robot's radius, or more if
    /// the validity checker requires more. After a change of the map, motions within this distance
    /// of the change are checked again.
    double obstacleReach = 1.;
};

/// A belief that the planner stores, and the node that it was propagated from, for auditTree().
struct TreeNode {
    const ompl::base::State* state;
    int parent;  ///< index of an earlier node; -1 for a start
    double cost;
    /// Covariance of T_c_w (left perturbation, camera frame); none if the planner propagates no
    /// covariances.
    std::optional<Matrix6> covariance;
};

/// How many vertices and edges of a planner an update changed. An update consists of the calls of
/// mapChanged() and moveRoot() after a solve(), and of the next solve().
struct UpdateCounts {
    std::size_t verticesInvalidated = 0;  ///< removed: in collision, or no longer reached
    std::size_t edgesInvalidated = 0;     ///< motions that were free and are in collision now
    std::size_t verticesAdded = 0;        ///< added by sampling
    std::size_t verticesRewired = 0;      ///< kept, with another parent than before
};

/// Base class of rrt_star, pa_rrt_star, rrbt and belief_rrt_star. Derived planners define how a new
/// vertex is connected and how the best path is found.
///
/// While map and root do not change, the solution is the best path found so far, even if the tree
/// changes: its cost never rises. When the map or the root changes, the best path is evaluated
/// again: it is dropped if it is no longer free, and its cost may rise.
class BeliefPlanner : public ompl::base::Planner {
  public:
    BeliefPlanner(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                  const std::string& name, const GrowthOptions& growth = {});
    ~BeliefPlanner() override;

    void setup() override;

    /// Grows until the condition holds or a limit of GrowthOptions is reached. Time for finish() is
    /// reserved only if the duration is known: by GrowthOptions::timeLimit (OMPL planner parameter
    /// `time_limit`), or by solve(seconds).
    /// @return EXACT_SOLUTION if a path is known, else TIMEOUT; INVALID_START and
    ///        UNRECOGNIZED_GOAL_TYPE as OMPL defines them
    ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;

    /// Solves for a given time [s]. The deadline is known in advance, other than with a termination
    /// condition, so that planners can reserve time to improve their path. Not virtual: called by a
    /// pointer to OMPL's base class it is OMPL's own, see GrowthOptions::timeLimit.
    ompl::base::PlannerStatus solve(double seconds);
    using ompl::base::Planner::solve;

    /// Every solve() ends also when this returns true; for conditions that the caller of solve(),
    /// for example OMPL's benchmark, does not know.
    void endWhen(std::function<bool()> isInterrupted) { isInterrupted_ = std::move(isInterrupted); }

    /// Replaces the clock of solve(double), whose value only ever grows [s].
    void setClock(std::function<double()> clock) { clock_ = std::move(clock); }

    /// Updates the planner after a change of the map. Clearance and information field must be
    /// updated first. Vertices and motions in collision are removed; motions that the change may
    /// have freed are checked again. The best path is kept only if it is still free; its cost is
    /// computed again with the views of the present map. It replaces all solutions of the problem
    /// definition. The next solve() continues from the updated planner. After an exception of the
    /// views, here or in moveRoot(), the next solve() begins anew, without vertices.
    void mapChanged(const MapChange& change);

    /// Plans from another state and belief from now on, for example while a path is flown. The
    /// state becomes the only root of the tree, and the start state of the problem definition until
    /// another one is set. The part of the best path ahead of the state is kept.
    /// @param belief belief at the state; its cost is part of the cost of all paths
    void moveRoot(const ompl::base::State* state, const Belief& belief);

    /// Sets a second model of the same belief, with more accurate views than model(). After an
    /// update, belief_rrt_star compares the kept path and a new one by this model; other planners
    /// do not use it. The costs that the planner returns are always those of model().
    void setReferenceModel(std::shared_ptr<BeliefModel> reference) {
        reference_ = std::move(reference);
    }

    void clear() override;
    void getPlannerData(ompl::base::PlannerData& data) const override;

    std::size_t vertices() const { return vertices_.size() - unused_.size(); }  ///< number of them
    /// Number of the vertices that GrowthOptions::maxVertices limits: not those of moveRoot().
    std::size_t samples() const { return vertices() - movedRoots_.size(); }
    std::size_t iterations() const { return iterations_; }  ///< number of samples so far
    double bestCost() const { return best_.cost; }          ///< infinite until the goal is reached
    /// The best path so far, from a root to a goal; empty if there is none. The planner owns the
    /// states. They are valid until the next call that is not const.
    const std::vector<ompl::base::State*>& bestPath() const { return best_.states; }
    /// The belief that moveRoot() has set at the root; none before the first call of moveRoot().
    const std::optional<Belief>& movedRoot() const { return movedRoot_; }
    BeliefModel& model() const { return *model_; }

    /// Counts of the present update so far. Before the first update only
    /// UpdateCounts::verticesAdded is set.
    const UpdateCounts& lastUpdate() const { return update_; }

    /// All beliefs that the planner stores, parents before children.
    virtual std::vector<TreeNode> tree() const = 0;

  protected:
    /// A start and the belief at the start.
    struct Root {
        Vertex* vertex;
        Belief belief;
    };

    /// Declares an OMPL parameter that sets an option of the planner.
    template <class T>
    void declareOption(const std::string& key, T& value) {
        params_.declareParam<T>(
            key, [&value](T v) { value = v; }, [&value] { return value; });
    }

    /// Called when a start has become a vertex.
    virtual void addRoot(const Root& root) = 0;

    /// The belief at a start. Renders the view from the start.
    virtual Belief rootBelief(const ompl::base::State* start) { return model_->root(start); }

    /// Connects a new vertex (not yet in the nearest-neighbour structure) to the vertices near it.
    /// The motion from the first of them, toward the sample, is free. Motions from the others are
    /// not checked for collision yet.
    virtual void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                         const ompl::base::PlannerTerminationCondition& ptc) = 0;

    /// Whether a sample whose nearest vertex is this one may improve the path. Most other samples
    /// are rejected. Some are accepted, so that no region is excluded for ever.
    virtual bool isPromising(const Vertex&) { return true; }

    /// Where samples are drawn after an update, until as many vertices were added as the update has
    /// removed or too many samples in a row have added none.
    virtual SampleShares sampleShares() const { return {}; }

    /// How many vertices an update that has blocked the best path adds beyond those that it has
    /// removed, for a detour over the rest of the graph that costs twice as much; a share of the
    /// vertices. The graph around the blocked path may be too sparse to show the next best one.
    virtual double growthPerDetour() const { return 0.; }

    /// Called when solve() begins.
    virtual void begin(const ompl::base::PlannerTerminationCondition&) {}

    /// Called when growth has ended. If time is left until the deadline of solve(double), growth
    /// continues afterwards.
    virtual void finish(const ompl::base::PlannerTerminationCondition&) {}

    /// Estimated duration of finish() [s]. Growth ends this time before the deadline.
    virtual double timeToFinish() const { return 0.; }

    /// By vertex index: the vertex from which the best belief of the vertex was propagated; null
    /// for a root and for a vertex without a belief.
    virtual std::vector<const Vertex*> parents() const = 0;

    /// The parts of a planner that a change of the map makes invalid.
    struct Invalid {
        std::vector<Vertex*> vertices;  // to be removed
        std::size_t edges = 0;          // number of edges that were free and are in collision now
    };
    /// Called when the map has changed: motions through changed space must be checked again.
    /// @param colliding vertices that are no longer valid
    /// @return these vertices and all others that must be removed
    virtual Invalid invalidate(const ChangedSpace& changed, std::vector<Vertex*> colliding) = 0;

    /// Called before a vertex is removed.
    virtual void removeEdgesOf(const Vertex& vertex) = 0;

    /// Called when the map has changed, after invalid vertices were removed: beliefs must be
    /// propagated again, because views may have changed.
    virtual void renewBeliefs() = 0;

    /// Called when `root` has become the only root.
    /// @param near if the root is a new vertex: the vertices near it, not connected yet
    /// @return vertices to be removed
    virtual std::vector<Vertex*> replaceRoots(const Root& root,
                                              const std::vector<Vertex*>& near) = 0;

    /// Whether other vertices are reached only by way of a former root.
    virtual bool isNeeded(const Vertex& formerRoot) = 0;

    /// The belief at the other end of a motion.
    virtual Belief propagate(const Belief& belief, Motion& motion, bool backward) {
        return model_->propagate(belief, motion, backward);
    }

    bool motionIsFree(const Vertex& from, const Vertex& to) const {
        return si_->checkMotion(from.state, to.state);
    }

    /// The vertices within the connection radius of RRT* around a vertex, and `nearest`, which
    /// comes first.
    std::vector<Vertex*> near(const Vertex& fresh, Vertex* nearest) const;

    /// Stores a path (start first) if it costs less than the best one so far.
    void offer(double cost, const std::vector<const ompl::base::State*>& path);

    /// Whether setReferenceModel() has set a second model.
    bool hasReferenceModel() const { return reference_ != nullptr; }
    /// The cost of a path from a root, by the model of setReferenceModel(), or by model() if there
    /// is none. Nothing if the condition has ended it before.
    std::optional<double> referenceCost(const std::vector<ompl::base::State*>& path,
                                        const ompl::base::PlannerTerminationCondition& ptc);
    /// Replaces the best path by this one (start first), even if it costs more.
    void replaceBest(double cost, const std::vector<const ompl::base::State*>& path);

    /// The time by the clock of solve(double) [s].
    double now() const { return clock_(); }
    /// Time until the deadline of solve(double) [s]; infinite without one.
    double secondsLeft() const { return deadline_ - now(); }
    bool hasDeadline() const { return deadline_ < kInfinity; }

    std::deque<Vertex> vertices_;  // removed ones have no state
    std::vector<Root> roots_;
    std::vector<Vertex*> goals_;
    std::shared_ptr<BeliefModel> model_;

  private:
    struct Solution {
        double cost;
        std::vector<ompl::base::State*> states;
    };
    struct Extension {
        Vertex* fresh;
        Vertex* nearest;
    };
    /// Values that benchmarks read from another thread while solve() runs.
    struct Progress {
        std::atomic<double> cost{kInfinity};
        std::atomic<std::size_t> vertices{0}, iterations{0}, views{0};
    };
    void publishProgress();
    bool addStarts();
    std::size_t mostVertices() const;  // 0: no limit
    bool isGrown() const;
    bool isTimeToFinish() const;
    double range() const;
    void growUntil(const ompl::base::PlannerTerminationCondition& ptc);
    void growToGoal(ompl::base::State* goal, const ompl::base::PlannerTerminationCondition& ptc);
    void grow(ompl::base::State* target, const ompl::base::PlannerTerminationCondition& ptc);
    void growToward(const ompl::base::State* target, bool isGoalSample,
                    const ompl::base::PlannerTerminationCondition& ptc);
    bool sample(ompl::base::State* state);
    std::optional<Extension> extend(const ompl::base::State* target);
    double connectionRadius() const;
    Vertex& addVertex(const ompl::base::State* state);
    void release(Vertex& vertex);
    void remove(const std::vector<Vertex*>& vertices);
    void removeColliding(const ChangedSpace& changed);
    void beginUpdate();
    void forgetParents(const std::vector<Vertex*>& removed);
    void countRewired();
    bool isRoot(const Vertex& vertex) const;
    void removeFormerRoots();
    void erase(const std::vector<Vertex*>& vertices);
    void joinRootToBest();
    void reevaluateBest();
    void dropBlocked();
    void growAroundBlocked();
    bool addBlocked();
    std::size_t verticesToAdd() const;
    void reportUpdate();
    void clearIfInterrupted(const std::function<void()>& update);
    std::optional<double> costOf(const std::vector<ompl::base::State*>& path);
    const Root* rootAt(const ompl::base::State* state) const;
    void addSolution();
    ompl::base::PlannerStatus report();
    ompl::base::PlannerStatus solveFor(double seconds,
                                       const ompl::base::PlannerTerminationCondition& ptc);
    ompl::base::PlannerStatus solveUntil(const ompl::base::PlannerTerminationCondition& ptc);
    void freeMemory();

    GrowthOptions growth_;
    std::shared_ptr<BeliefModel> reference_;  // null: model_
    std::function<bool()> isInterrupted_ = [] { return false; };
    std::function<double()> clock_;  // [s]
    std::shared_ptr<ompl::NearestNeighbors<Vertex*>> neighbours_;
    ompl::base::StateSamplerPtr sampler_;
    ompl::RNG rng_;
    Solution best_;
    /// A best path that a change blocked: what is left of it after moveRoot() may be free.
    std::vector<ompl::base::State*> blocked_;
    double blockedCost_ = kInfinity;
    std::size_t forBlocked_ = 0;     // vertices allowed for such paths, in all
    std::size_t forBlockedNow_ = 0;  // in this update
    std::optional<Belief> movedRoot_;
    double deadline_ = kInfinity;  // by the clock [s]
    double budget_ = 0.;           // of the solve() that has a deadline [s]
    std::size_t iterations_ = 0;
    std::size_t iterationsAtChange_ = 0;      // of the map or the root, the last one
    std::uint32_t fieldEpoch_ = 0;            // whose views the beliefs are made of
    std::vector<const Vertex*> goalSamples_;  // vertices that were sampled at a goal
    std::vector<Vertex*> movedRoots_;         // added by moveRoot(): they are no samples
    std::vector<Vertex*> unused_;             // removed, to be used again
    UpdatedSpace updated_;                    // until it is grown again
    int failures_ = 0;                        // samples in a row that added no vertex
    UpdateCounts update_;
    bool isSolved_ = false;                     // update_ has had its solve()
    std::vector<const Vertex*> parentsBefore_;  // the update, by vertex; null: not to be compared
    Progress progress_;
    ompl::base::OptimizationObjectivePtr objective_;
};

}  // namespace photonav
