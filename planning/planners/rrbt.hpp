// SPDX-License-Identifier: BSD-3-Clause
// Rapidly-exploring random belief trees: a baseline that keeps all beliefs that are not dominated.
#pragma once

#include "planners/belief_planner.hpp"
#include "planners/roadmap.hpp"

namespace photonav {

/// RRBT of Bry and Roy (Rapidly-exploring random belief trees for motion planning under
/// uncertainty, ICRA 2011).
///
/// As published: a graph is grown by sampling. Each vertex has any number of belief nodes, each
/// with a cost, a covariance and a parent node. A new vertex is joined to the nearest vertex and to
/// all vertices within the radius of RRG. The beliefs of its neighbours are queued, and all beliefs
/// in the queue are propagated over the edges until the queue is empty. A belief is appended unless
/// another one at the same vertex is better in the partial order
///     a < b  <=>  cost_a < cost_b  and  Sigma_a < Sigma_b + epsilon 1  (Loewner order).
/// It then removes the beliefs that are worse than itself (with epsilon = 0) and their descendants.
/// The number of beliefs of a vertex is not limited, and the best path so far is not used as a
/// bound.
///
/// Adapted to our problem: motions are straight lines of at most `range`, whose views, noise and
/// costs are those of BeliefModel::propagate, as for all planners. There is no controller, hence no
/// covariance of the controlled position, and a minimum clearance replaces the chance constraint on
/// collisions. epsilon weighs rotations by the characteristic length, as the trace does. The queue
/// is sorted by cost. When a new vertex appears, the beliefs of its neighbours are propagated over
/// the new edges only.
class RRBT : public BeliefPlanner {
  public:
    /// @param epsilon slack of the partial order [m^2]: a larger one keeps fewer beliefs
    RRBT(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
         const GrowthOptions& growth = {}, double epsilon = 1e-3);

    void clear() override;
    std::vector<TreeNode> tree() const override;

    /// Number of beliefs at all vertices together. May be read while another thread runs solve().
    std::size_t beliefs() const { return beliefs_; }

  private:
    struct Node {
        Vertex* vertex;
        Node* parent;
        Belief belief;
        std::vector<Node*> children = {};
        bool isRemoved = false;
    };

    void addRoot(const Root& root) override;
    void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                 const ompl::base::PlannerTerminationCondition& ptc) override;
    void begin(const ompl::base::PlannerTerminationCondition& ptc) override { propagateQueue(ptc); }
    std::vector<const Vertex*> parents() const override;
    Invalid invalidate(const ChangedSpace& changed, std::vector<Vertex*> colliding) override;
    SampleShares sampleShares() const override { return {.removed = 0.6, .changed = 0.2}; }
    void removeEdgesOf(const Vertex& vertex) override { roadmap_.removeEdgesOf(vertex); }
    void renewBeliefs() override;
    std::vector<Vertex*> replaceRoots(const Root& root, const std::vector<Vertex*>& near) override;
    bool isNeeded(const Vertex& formerRoot) override {
        return !roadmap_.isReplacedBy(*roots_.front().vertex, formerRoot, *si_);
    }

    void propagateQueue(const ompl::base::PlannerTerminationCondition& ptc);
    void propagateFrom(Node& node);
    void propagateOver(Node& node, Roadmap::Edge& edge);
    void appendBelief(Vertex& vertex, Node& parent, const Belief& belief);
    bool isAtLeastAsGood(const Belief& a, const Belief& b, double epsilon) const;
    void remove(Node& node);
    void enqueue(Node& node);
    void offerPath(const Node& goal);

    double epsilon_;
    Roadmap roadmap_;
    std::deque<Node> nodes_;
    std::vector<std::vector<Node*>> nodesOf_;  // by vertex
    std::vector<Node*> queue_;                 // heap, cheapest first
    std::atomic<std::size_t> beliefs_ = 0;     // nodes that are not removed
};

}  // namespace photonav
