// SPDX-License-Identifier: BSD-3-Clause
// The paper's Algorithm 1, and RRT* as its special case without beliefs.
#pragma once

#include "planners/belief_planner.hpp"

namespace photonav {

/// Perception-aware RRT* as published (Algorithm 1): each vertex has one belief and the parent with
/// the least cost-to-come; rewiring updates the beliefs of all descendants. A change of the map is
/// handled as in Algorithm 2; docs/concepts/online-planning.md compares its lines with this
/// implementation. Minimises::length gives the standard RRT*, named rrt_star, which renders no
/// views.
class PerceptionRRTstar : public BeliefPlanner {
  public:
    enum class Minimises { lengthAndUncertainty, length };

    /// @throws std::invalid_argument for Minimises::length unless alpha = 1
    PerceptionRRTstar(const ompl::base::SpaceInformationPtr& si,
                      const std::shared_ptr<BeliefModel>& model, const GrowthOptions& growth = {},
                      Minimises minimises = Minimises::lengthAndUncertainty);

    void clear() override;
    std::vector<TreeNode> tree() const override;

  private:
    /// A vertex of the tree, the motion that reached it and the belief there.
    struct Branch {
        Vertex* parent = nullptr;
        Motion motion;          // between the vertex and its parent, in either direction
        bool backward = false;  // the parent is at motion.to
        Belief belief;
        std::vector<Vertex*> children;
    };
    struct Candidate {
        Vertex* vertex;
        Motion motion;  // from the vertex to the new one
        std::optional<bool> isFree;
    };

    void addRoot(const Root& root) override;
    Belief rootBelief(const ompl::base::State* start) override {
        return shortestPath_ ? Belief{} : BeliefPlanner::rootBelief(start);
    }
    void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                 const ompl::base::PlannerTerminationCondition& ptc) override;
    std::vector<const Vertex*> parents() const override;
    Invalid invalidate(const ChangedSpace& changed, std::vector<Vertex*> colliding) override;
    void removeEdgesOf(const Vertex& vertex) override;
    void renewBeliefs() override;
    SampleShares sampleShares() const override { return {.removed = 1.}; }
    void finish(const ompl::base::PlannerTerminationCondition& ptc) override;
    std::vector<Vertex*> replaceRoots(const Root& root, const std::vector<Vertex*>& near) override;
    bool isNeeded(const Vertex& formerRoot) override { return !at(formerRoot).children.empty(); }
    Belief propagate(const Belief& belief, Motion& motion, bool backward) override;

    std::vector<Candidate> candidatesOf(const Vertex& vertex, const std::vector<Vertex*>& near);
    bool attach(Vertex& vertex, std::vector<Candidate>& candidates);
    void reverseWayTo(Vertex& root);
    std::vector<Vertex*> withDescendants(const std::vector<Vertex*>& vertices);
    std::vector<Vertex*> unreached(const Vertex& root);
    void chooseParent(Vertex& fresh, std::vector<Candidate>& candidates);
    void rewire(Vertex& fresh, std::vector<Candidate>& candidates);
    void updateSubtree(const Vertex& root, const Belief& belief);
    bool hasChangedViews(const Motion& motion) const;
    void offerBestGoal();
    bool isFree(Candidate& candidate, const Vertex& fresh) const;
    Branch& at(const Vertex& vertex) { return tree_[vertex.index]; }
    const Belief& belief(const Vertex& vertex) const { return tree_[vertex.index].belief; }

    bool shortestPath_;              // no beliefs
    std::deque<Branch> tree_;        // by vertex
    std::vector<Vertex*> informed_;  // V_inf of Algorithm 2, until they are rewired
};

}  // namespace photonav
