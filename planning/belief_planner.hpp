// SPDX-License-Identifier: BSD-3-Clause
// What all our planners share: growing a set of vertices by sampling, and OMPL's planner contract.
#pragma once

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/Planner.h>
#include <ompl/datastructures/NearestNeighbors.h>
#include <ompl/util/RandomNumbers.h>

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "belief.hpp"
#include "constants.hpp"

namespace photonav {

struct GrowthOptions {
    double range = 0.;          ///< longest motion added [m]; 0: a fifth of the space's extent
    double goalBias = 0.05;     ///< share of samples drawn at the goal until it is reached
    double rewireFactor = 1.1;  ///< on the connection radius of Karaman and Frazzoli 2011
    std::uint32_t seed = 1;     ///< of everything random in the planner
    /// solve() stops growing with as many vertices, or after as many samples, and finishes what it
    /// has; 0: with the termination condition.
    unsigned maxVertices = 0;
    std::size_t maxIterations = 0;
};

/// A vertex and the motion that reached it.
struct Vertex {
    ompl::base::State* state = nullptr;
    Vertex* parent = nullptr;
    Motion motion;          ///< between this vertex and its parent, in either direction
    bool backward = false;  ///< flown from motion.to to motion.from
    Belief belief;
    std::vector<Vertex*> children;
    std::uint32_t index = 0;
    bool isGoal = false;
};

/// A belief the planner stores, and the node it was propagated from: what an audit replays.
struct TreeNode {
    const ompl::base::State* state;
    int parent;  ///< index of an earlier node; -1 for a start
    double cost;
    std::optional<Matrix6> covariance;  ///< none when the planner never looked at beliefs
};

/// Base of rrt_star, pa_rrt_star and belief_rrt_star. Derived planners say how a new vertex is
/// connected and where the best path is; everything else is here.
///
/// The answer is the best path ever found: its cost never rises, whatever happens to the tree.
class BeliefPlanner : public ompl::base::Planner {
  public:
    BeliefPlanner(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                  const std::string& name, const GrowthOptions& growth = {});
    ~BeliefPlanner() override;

    void setup() override;
    ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;
    void clear() override;
    void getPlannerData(ompl::base::PlannerData& data) const override;

    std::size_t vertices() const { return vertices_.size(); }
    std::size_t iterations() const { return iterations_; }
    double bestCost() const { return best_.cost; }  ///< infinite until the goal is reached
    BeliefModel& model() const { return *model_; }

    /// Every belief the planner holds, parents before children.
    virtual std::vector<TreeNode> tree() const = 0;

  protected:
    /// Joins a new vertex (not yet in the tree) to its neighbours, to which motions are short but
    /// unchecked; the first of them is the vertex it was steered from, checked.
    virtual void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                         const ompl::base::PlannerTerminationCondition& ptc) = 0;

    /// Whether a sample whose nearest vertex is this one is worth a try. Asked for most samples;
    /// the rest are taken wherever they fall, so that what is unknown is found in the end.
    virtual bool isPromising(const Vertex&) { return true; }

    /// Called before solve() returns, when the vertex set is final for now.
    virtual void finish(const ompl::base::PlannerTerminationCondition&) {}

    bool motionIsFree(const Vertex& from, const Vertex& to) const {
        return si_->checkMotion(from.state, to.state);
    }

    /// Keeps the path to the back of `path` (start first) if it is the best ever.
    void offer(double cost, const std::vector<const ompl::base::State*>& path);

    std::deque<Vertex> vertices_;
    std::vector<Vertex*> starts_;
    std::vector<Vertex*> goals_;
    std::shared_ptr<BeliefModel> model_;

  private:
    struct Solution {
        double cost;
        std::vector<ompl::base::State*> states;
    };

    bool isGrown() const {
        return (growth_.maxVertices > 0 && vertices_.size() >= growth_.maxVertices) ||
               (growth_.maxIterations > 0 && iterations_ >= growth_.maxIterations);
    }
    /// What benchmarks sample from another thread while solve() runs.
    struct Progress {
        std::atomic<double> cost{kInfinity};
        std::atomic<std::size_t> vertices{0}, iterations{0}, views{0};
    };
    void publishProgress();
    bool addStarts();
    bool sample(ompl::base::State* state);
    Vertex* extend(const ompl::base::State* target);
    std::vector<Vertex*> near(const Vertex& fresh, Vertex* nearest) const;
    Vertex& addVertex(const ompl::base::State* state);
    ompl::base::PlannerStatus report();
    void freeMemory();

    GrowthOptions growth_;
    double range_ = 0.;
    std::shared_ptr<ompl::NearestNeighbors<Vertex*>> neighbours_;
    ompl::base::StateSamplerPtr sampler_;
    ompl::RNG rng_;
    Solution best_;
    std::size_t iterations_ = 0;
    unsigned goalSamples_ = 0;
    Progress progress_;
    ompl::base::OptimizationObjectivePtr objective_;
};

}  // namespace photonav
