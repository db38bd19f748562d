// SPDX-License-Identifier: BSD-3-Clause
// Belief search over a sampled roadmap: the default planner.
#pragma once

#include <ompl/geometric/PathGeometric.h>

#include <atomic>

#include "geometry/constants.hpp"
#include "planners/belief_planner.hpp"
#include "planners/cost_to_go.hpp"
#include "planners/path_descent.hpp"
#include "planners/roadmap.hpp"

namespace photonav {

struct SearchOptions {
    unsigned labels = 5;       ///< largest number of labels kept per vertex
    bool informed = true;      ///< reject most samples where no better path can pass
    unsigned shortcut = 3000;  ///< largest number of changes tried on a search's best path
    /// After an update another path replaces the kept one only if it costs less by this share.
    /// Costs change a little with every new view of the map, and a robot that follows each of these
    /// changes turns back and forth. Changes of the kept path itself are always accepted.
    double commitment = 0.;
    /// Weighted A*: factor, from 0 to 1, on the raise of the bound on the cost-to-go. Where views
    /// inform nearly everywhere, paths cost more than the base cost (see CostToGo) by about the
    /// same share. A search raises its bound by this share, as the last search has found it, times
    /// `inflation`. It then expands fewer labels. Its path costs more than the best one over the
    /// roadmap by at most the share by which the bound is raised.
    double inflation = 0.;
};

/// Grows a roadmap with the samples and the connection radius of RRT*, keeps all its edges, and
/// searches over beliefs with several labels (vertex, belief) per vertex. A path to a vertex that
/// costs more but has a smaller covariance is kept unless it is dominated in the partial order of
/// cost and covariance (Loewner order; Bry and Roy 2011). The paper's Algorithm 1 keeps only the
/// cheapest belief and can stay in a local minimum however many vertices it adds.
///
/// The number of labels is limited and the partial order has a slack, so the result is the best
/// path over the labels kept, not over all beliefs.
///
/// The views along an edge are rendered only when a label is about to be propagated along the edge.
/// All edges are checked for collision before a search: a check takes microseconds, a view a
/// millisecond, and the bound that steers the search then does not lead through walls.
///
/// The planner is anytime: whenever the roadmap has doubled, it is searched, and as many changes
/// are tried on the resulting path as the roadmap has vertices. Then growth continues. With a known
/// deadline (solve(double)) the last search and the descent from its path begin in time; a
/// termination condition stops the planner at once.
class BeliefRRTstar : public BeliefPlanner {
  public:
    /// Number of vertices of the roadmap at its first search. A path over edges that are known to
    /// be free may be found before.
    static constexpr std::size_t kFirstSearch = 100;
    /// The same with a known deadline, which may be near: a search of few vertices renders few
    /// views.
    static constexpr std::size_t kFirstSearchWithDeadline = 8;

    BeliefRRTstar(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                  const SearchOptions& search = {}, const GrowthOptions& growth = {});

    void clear() override;
    std::vector<TreeNode> tree() const override;

    /// Number of changes of paths tried so far.
    unsigned shortcutsTried() const { return shortcutsTried_; }

  private:
    struct Label {
        Vertex* vertex;
        int parent;  // index into settled_; -1 at a start
        Belief belief;
    };
    /// A label that is not settled yet. Its belief is propagated only when it comes first.
    struct Candidate {
        double bound;  // least cost of a path to the goal through here
        int parent;
        Roadmap::Edge* edge;                  // from the parent; none at a start
        Vertex* vertex;                       // where it leads
        std::unique_ptr<Belief> belief = {};  // there, once propagated

        bool operator<(const Candidate& other) const { return bound > other.bound; }
    };
    using Open = std::vector<Candidate>;  // a heap, the least bound in front

    /// Upper limit of the cost of a path over the roadmap. It includes the best path so far, so
    /// that a search finds it again.
    double limit() const { return std::min(pathCost_, limitOfUpdate_) * (1. + 1e-12); }
    double limitOfUpdate() const;
    void offerAnother(double cost, const std::vector<const ompl::base::State*>& path);

    void addRoot(const Root&) override { isSearchDue_ = true; }
    void begin(const ompl::base::PlannerTerminationCondition& ptc) override;
    void connect(Vertex& fresh, const std::vector<Vertex*>& near,
                 const ompl::base::PlannerTerminationCondition& ptc) override;
    bool isPromising(const Vertex& nearest) override;
    void finish(const ompl::base::PlannerTerminationCondition& ptc) override;
    SampleShares sampleShares() const override { return {.removed = 0.6, .changed = 0.2}; }
    double growthPerDetour() const override { return 0.1; }
    double timeToFinish() const override;
    std::vector<const Vertex*> parents() const override;
    Invalid invalidate(const ChangedSpace& changed, std::vector<Vertex*> colliding) override;
    void removeEdgesOf(const Vertex& vertex) override { roadmap_.removeEdgesOf(vertex); }
    void renewBeliefs() override;
    std::vector<Vertex*> replaceRoots(const Root& root, const std::vector<Vertex*>& near) override;
    bool isNeeded(const Vertex& formerRoot) override {
        return !roadmap_.isReplacedBy(*roots_.front().vertex, formerRoot, *si_);
    }

    void offerCheckedPath(const Vertex& goal, const ompl::base::PlannerTerminationCondition& ptc);
    void search(const ompl::base::PlannerTerminationCondition& ptc);
    void push(Open& open, Candidate candidate) const;
    void expand(int label, Open& open) const;
    bool propagateTo(Candidate& candidate);
    bool isFull(const Vertex& vertex) const {
        return labelsOf_[vertex.index].size() >= options_.labels;
    }
    bool isDominated(const Vertex& vertex, const Belief& belief) const;
    void keepPath(int label);
    void descend(const ompl::base::PlannerTerminationCondition& ptc, unsigned changes);
    void descend(PathDescent& descent, const ompl::base::PlannerTerminationCondition& ptc,
                 unsigned changes);
    PathDescent descentAt(const std::vector<const ompl::base::State*>& path,
                          double firstStep) const;
    void follow(const ompl::base::PlannerTerminationCondition& ptc);
    void compareWithKept(const ompl::base::PlannerTerminationCondition& ptc);

    SearchOptions options_;
    Roadmap roadmap_;
    CostToGo toGo_;
    std::vector<Label> settled_;              // in the order they were settled
    std::vector<std::vector<int>> labelsOf_;  // by vertex, into settled_
    std::size_t searched_ = 0;                // number of vertices at the last complete search
    bool isSearchDue_ = false;                // something has changed since
    bool isFollowing_ = false;                // an update has kept a path
    double keptCost_ = kInfinity;             // of this path
    std::optional<ompl::geometric::PathGeometric> kept_;  // the same, for the reference model
    double limitOfUpdate_ = kInfinity;                    // see limitOfUpdate()
    bool isWellObserved_ = true;                          // along the last path
    double overBase_ = 1.;                                // its cost over its base cost
    double raise_ = 1.;                                   // factor on the bound, in this search
    double gain_ = 1.;                                    // see limitOfUpdate()
    std::vector<bool> promising_;                 // by vertex, from the last search while growing
    std::vector<const ompl::base::State*> path_;  // the best over the roadmap
    double pathCost_ = kInfinity;
    std::optional<PathDescent> descent_;        // from path_
    double searchSeconds_ = 0.;                 // of the last complete search
    double descentSeconds_ = 0.;                // of all changes tried
    std::atomic<unsigned> shortcutsTried_ = 0;  // progress properties are read from other threads
    std::atomic<unsigned> shortcutsTaken_ = 0;
};

}  // namespace photonav
