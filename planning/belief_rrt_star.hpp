// SPDX-License-Identifier: BSD-3-Clause
// Belief search over a sampled roadmap: the default planner.
#pragma once

#include "belief_planner.hpp"

namespace photonav {

/// Grows the roadmap that RRT* would (same samples, same connection radius), keeps all its edges,
/// and searches beliefs over it with several labels per vertex: a costlier way to a vertex that
/// arrives there better localised is kept as long as it is not dominated in the partial order of
/// cost and covariance (Loewner order; Bry and Roy 2011). Algorithm 1 keeps only the cheapest and
/// can stay in the wrong plateau however many vertices it adds.
///
/// The cap on the labels and a slack in the order make the answer the best of the labels kept, not
/// of all beliefs.
///
/// Edges are checked for collision, and looked from, only when a label is about to fly them.
class BeliefRRTstar : public BeliefPlanner {
  public:
    BeliefRRTstar(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                  unsigned labels = 5, const GrowthOptions& growth = {});

    void clear() override;
    std::vector<TreeNode> tree() const override;

  private:
    struct Edge {
        Vertex* from;
        Vertex* to;
        Motion motion;
        std::optional<bool> isFree;
    };
    struct Label {
        Vertex* vertex;
        int parent;  // index into settled_; -1 at a start
        Belief belief;
        double bound;  // least cost of a path to the goal through here
    };
    using Open = std::vector<std::unique_ptr<Label>>;

    void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                 const ompl::base::PlannerTerminationCondition& ptc) override;
    void finish(const ompl::base::PlannerTerminationCondition& ptc) override;
    void search(const ompl::base::PlannerTerminationCondition& ptc);
    std::vector<double> distancesToGoal() const;
    void expand(int label, const std::vector<double>& toGoal, Open& open);
    bool isDominated(const Vertex& vertex, const Matrix6& covariance, double toGoal) const;
    void offerPath(int label);

    unsigned maxLabels_;
    std::deque<Edge> edges_;
    std::vector<std::vector<Edge*>> edgesOf_;  // by vertex
    std::vector<Label> settled_;               // in the order they were settled
    std::vector<std::vector<int>> labelsOf_;   // by vertex, into settled_
    std::size_t searched_ = 0;                 // number of vertices at the last complete search
};

}  // namespace photonav
