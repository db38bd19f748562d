// SPDX-License-Identifier: BSD-3-Clause
// What all our planners share: growing a set of vertices by sampling, and OMPL's planner contract.
#pragma once

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/Planner.h>
#include <ompl/datastructures/NearestNeighbors.h>
#include <ompl/util/RandomNumbers.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "belief/belief.hpp"
#include "geometry/constants.hpp"
#include "planners/changed_space.hpp"
#include "planners/updated_space.hpp"
#include "planners/vertex.hpp"

namespace photonav {

struct GrowthOptions {
    double range = 0.;          ///< longest motion added [m]; 0: a fifth of the space's extent
    double goalBias = 0.05;     ///< share of samples drawn at the goal until it is reached
    double rewireFactor = 1.1;  ///< on the connection radius of Karaman and Frazzoli 2011
    std::uint32_t seed = 1;     ///< of everything random in the planner
    /// Growth ends with this number of vertices, or of samples since the map or the root last
    /// changed; then finish() is called. 0: no limit but the termination condition.
    unsigned maxVertices = 0;
    std::size_t maxIterations = 0;
    /// Obstacles farther away than this do not matter: the robot's radius, or more if the validity
    /// checker requires more [m]. mapChanged() checks motions within this distance of a change
    /// again.
    double obstacleReach = 1.;
};

/// A belief that the planner stores, and the node it was propagated from, for auditTree().
struct TreeNode {
    const ompl::base::State* state;
    int parent;  ///< index of an earlier node; -1 for a start
    double cost;
    std::optional<Matrix6> covariance;  ///< of T_c_w, camera frame, left; none where the planner
                                        ///< propagates no covariances
};

/// How much of a planner an update changed: the calls of mapChanged() and moveRoot() since the last
/// solve(), and the solve() after them.
struct UpdateCounts {
    std::size_t verticesInvalidated = 0;  ///< removed: in collision, or no longer reached
    std::size_t edgesInvalidated = 0;     ///< motions that had been free and are in collision now
    std::size_t verticesAdded = 0;        ///< by sampling
    std::size_t verticesRewired = 0;      ///< kept, but reached from another vertex than before
};

/// Base of rrt_star, pa_rrt_star, rrbt and belief_rrt_star. Derived planners define how a new
/// vertex is connected and where the best path is; everything else is here.
///
/// While map and root stay, the solution is the best path ever found: its cost never rises,
/// whatever happens to the tree. When one of them changes, the best path is evaluated again: it is
/// dropped if it is no longer free, and its cost may rise.
class BeliefPlanner : public ompl::base::Planner {
  public:
    BeliefPlanner(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                  const std::string& name, const GrowthOptions& growth = {});
    ~BeliefPlanner() override;

    void setup() override;

    /// Grows until the condition holds or the vertices or iterations of the options are used up,
    /// then calls finish().
    ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;

    /// Solves for a given time [s]. Unlike with a termination condition the end is known in
    /// advance, so that planners can reserve time to improve their path.
    ompl::base::PlannerStatus solve(double seconds);
    using ompl::base::Planner::solve;

    /// Updates the planner after a change of the map. Clearance and information field must be
    /// updated first. Vertices and motions in collision are removed; motions that the change may
    /// have freed are checked again. The best path is kept only if it is still free; its cost is
    /// computed again in the views of the present map. The same holds for the solutions of the
    /// problem definition. The next solve() continues from there.
    void mapChanged(const MapChange& change);

    /// Plans from another state and belief from now on, for example while a path is flown. The
    /// state becomes the only root of the tree, and the start state of the problem definition until
    /// another one is set. The part of the best path ahead of it is kept.
    /// @param belief as those of BeliefModel; costs are counted from its cost
    void moveRoot(const ompl::base::State* state, const Belief& belief);

    /// Another model, of the same belief but with better views, that decides between paths that
    /// may be the best: model() only ranks them then. Costs of the planner stay those of model().
    void judgeBy(std::shared_ptr<BeliefModel> judge) { judge_ = std::move(judge); }

    void clear() override;
    void getPlannerData(ompl::base::PlannerData& data) const override;

    std::size_t vertices() const { return vertices_.size() - unused_.size(); }
    std::size_t iterations() const { return iterations_; }
    double bestCost() const { return best_.cost; }  ///< infinite until the goal is reached
    /// The best path so far, from a root on; empty if there is none. The planner owns the states:
    /// they are those of the path until it goes on or is changed.
    const std::vector<ompl::base::State*>& bestPath() const { return best_.states; }
    /// The belief at the root, once moveRoot() has set it.
    const std::optional<Belief>& movedRoot() const { return movedRoot_; }
    BeliefModel& model() const { return *model_; }

    /// What the present update changed so far; of the first plan, before any update, the vertices
    /// that were added.
    const UpdateCounts& lastUpdate() const { return update_; }

    /// Every belief the planner holds, parents before children.
    virtual std::vector<TreeNode> tree() const = 0;

  protected:
    /// A start and the belief there.
    struct Root {
        Vertex* vertex;
        Belief belief;
    };

    /// A parameter of OMPL that sets an option of the planner.
    template <class T>
    void declareOption(const std::string& key, T& value) {
        params_.declareParam<T>(
            key, [&value](T v) { value = v; }, [&value] { return value; });
    }

    /// Called when a start has become a vertex.
    virtual void addRoot(const Root& root) = 0;

    /// The belief at a start; renders the view from there.
    virtual Belief rootBelief(const ompl::base::State* start) { return model_->root(start); }

    /// Connects a new vertex (not yet in the nearest-neighbour structure) to the vertices near it.
    /// Motions to them are short but not checked for collision, except to the first one, from which
    /// the new vertex was steered.
    virtual void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                         const ompl::base::PlannerTerminationCondition& ptc) = 0;

    /// Whether a sample whose nearest vertex is this one may improve the path. Asked for most
    /// samples; the others are accepted anywhere, so that no region is excluded for ever.
    virtual bool isPromising(const Vertex&) { return true; }

    /// Where samples are drawn after an update, until as many vertices were added as it removed or
    /// too many samples in a row have added none.
    virtual SampleShares sampleShares() const { return {}; }

    /// Called when solve() begins.
    virtual void begin(const ompl::base::PlannerTerminationCondition&) {}

    /// Called before solve() returns, when it adds no more vertices.
    virtual void finish(const ompl::base::PlannerTerminationCondition&) {}

    /// Estimated duration of finish() [s]: growth ends that long before the deadline.
    virtual double timeToFinish() const { return 0.; }

    /// By vertex index the vertex that its best belief comes from; null at a root, and where there
    /// is no belief.
    virtual std::vector<const Vertex*> parents() const = 0;

    /// Called when the map has changed: motions through changed space must be checked again.
    struct Invalid {
        std::vector<Vertex*> vertices;  // to be removed
        std::size_t edges = 0;          // that had been free and are in collision now
    };
    /// @param colliding vertices that are no longer valid
    /// @return these vertices, and what else has to go
    virtual Invalid invalidate(const ChangedSpace& changed, std::vector<Vertex*> colliding) = 0;

    /// Called before a vertex is removed.
    virtual void removeEdgesOf(const Vertex& vertex) = 0;

    /// Called when the map has changed and vertices are removed: views may have changed as well.
    virtual void renewBeliefs() = 0;

    /// Called when `root` has become the only root.
    /// @param near if root is a new vertex: the vertices near it, not connected yet
    /// @return vertices to be removed
    virtual std::vector<Vertex*> replaceRoots(const Root& root,
                                              const std::vector<Vertex*>& near) = 0;

    /// The belief at the other end of a motion.
    virtual Belief propagate(const Belief& belief, Motion& motion, bool backward) {
        return model_->propagate(belief, motion, backward);
    }

    bool motionIsFree(const Vertex& from, const Vertex& to) const {
        return si_->checkMotion(from.state, to.state);
    }

    /// Vertices within the radius of RRT*, `nearest` in front.
    std::vector<Vertex*> near(const Vertex& fresh, Vertex* nearest) const;

    /// Stores a path (start first) if it is the best so far.
    void offer(double cost, const std::vector<const ompl::base::State*>& path);

    /// Whether another model than model() decides what path is best.
    bool hasJudge() const { return judge_ != nullptr; }
    /// What a path from a root on costs by judgeBy(), views at hand or not.
    double judgedCost(const std::vector<ompl::base::State*>& path);
    /// Takes a path (start first) in place of the best one, whatever it costs.
    void replaceBest(double cost, const std::vector<const ompl::base::State*>& path);

    /// Time until the deadline of solve(double) [s]; infinite without one.
    double secondsLeft() const;

    std::deque<Vertex> vertices_;  // removed ones have no state
    std::vector<Root> roots_;
    std::vector<Vertex*> goals_;
    std::shared_ptr<BeliefModel> model_;

  private:
    using Clock = std::chrono::steady_clock;
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
    bool isGrown() const;
    bool isTimeToFinish() const;
    double range() const;
    void growUntil(const ompl::base::PlannerTerminationCondition& ptc);
    void grow(ompl::base::State* target, const ompl::base::PlannerTerminationCondition& ptc);
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
    void joinRootToBest();
    void reevaluateBest();
    std::optional<double> costOf(const std::vector<ompl::base::State*>& path);
    const Root* rootAt(const ompl::base::State* state) const;
    void setStartOfProblem(const ompl::base::State* state);
    void addSolution();
    ompl::base::PlannerStatus report();
    void freeMemory();

    GrowthOptions growth_;
    std::shared_ptr<BeliefModel> judge_;  // null: model_
    std::shared_ptr<ompl::NearestNeighbors<Vertex*>> neighbours_;
    ompl::base::StateSamplerPtr sampler_;
    ompl::RNG rng_;
    Solution best_;
    std::optional<Belief> movedRoot_;
    std::optional<Clock::time_point> deadline_;
    double budget_ = 0.;  // of the solve() that has a deadline [s]
    std::size_t iterations_ = 0;
    std::size_t iterationsAtChange_ = 0;      // of the map or the root, the last one
    std::vector<const Vertex*> goalSamples_;  // vertices that were sampled at a goal
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
