// SPDX-License-Identifier: BSD-3-Clause
// The paper's Algorithm 1, and RRT* as its special case alpha = 1.
#pragma once

#include "belief_planner.hpp"

namespace photonav {

/// Perception-aware RRT* as published (Algorithm 1): one belief per vertex, the parent with the
/// least cost-to-come, rewiring with the beliefs of all descendants brought up to date. Where
/// alpha = 1 no belief matters: it is the standard RRT*, and no view is ever rendered.
class PerceptionRRTstar : public BeliefPlanner {
  public:
    PerceptionRRTstar(const ompl::base::SpaceInformationPtr& si,
                      const std::shared_ptr<BeliefModel>& model, const GrowthOptions& growth = {});

    std::vector<TreeNode> tree() const override;

  private:
    struct Candidate {
        Vertex* vertex;
        Motion motion;  // from the vertex to the new one
        std::optional<bool> isFree;
    };

    void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                 const ompl::base::PlannerTerminationCondition& ptc) override;
    void chooseParent(Vertex& fresh, std::vector<Candidate>& candidates);
    void rewire(Vertex& fresh, std::vector<Candidate>& candidates);
    void updateSubtree(Vertex& root);
    void offerBestGoal();
    Belief fly(const Belief& belief, Motion& motion, bool backward);
    bool isFree(Candidate& candidate, const Vertex& fresh) const;

    bool shortestPath_;  // alpha = 1
};

}  // namespace photonav
