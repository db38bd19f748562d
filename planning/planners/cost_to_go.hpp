// SPDX-License-Identifier: BSD-3-Clause
// A lower bound on the cost-to-go of a belief over a roadmap: the heuristic of the search.
#pragma once

#include <array>

#include "geometry/constants.hpp"

#include "planners/roadmap.hpp"

namespace photonav {

/// A lower bound on the cost-to-go over a roadmap, the sum of two parts.
///
/// The base cost is the least cost of a motion, even if the pose is known exactly before the
/// motion: alpha times its length, and the cost of the motion noise. The noise of a step is in the
/// covariance at the end of the step, before the next view, so that it counts over half the step.
/// Where views inform nearly everywhere, motions cost little more than this.
///
/// The second part is the cost of the uncertainty at the start. The conditional variance of a
/// position coordinate given all others (the inverse of the precision's diagonal) never falls with
/// motion; only a view that observes the coordinate reduces it. So it counts at least until the
/// nearest vertex with such a view, and a path by way of this vertex must go on from there to the
/// goal.
///
/// The views along a motion are not known before they are rendered. They are assumed to observe an
/// axis only if the view at one of the two ends does. The bound can therefore be too high where a
/// texture lies between two vertices and is visible from neither; this error vanishes as motions
/// get shorter. A stale view is assumed to observe all axes. An axis counts as not observed if the
/// view has less than 1e-9 of the information about it that it has about the axis it observes best:
/// images are of single precision, and their rounding alone makes 3e-11 of it. Fourth-order terms
/// and most of this information are covered by reducing the second part by 1 %.
class CostToGo {
  public:
    /// A vertex at which a search begins, and its covariance as in Belief.
    struct Start {
        const Vertex* vertex;
        Matrix6 covariance;
    };

    /// Computes the bound for a roadmap and the views of the model's field. Views from vertices
    /// that are not in the field yet are rendered, except for vertices within `ds` of one that was
    /// evaluated. Stale views are not rendered again.
    void update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                const std::vector<Vertex*>& goals, BeliefModel& model);

    /// Computes the bound for a search from these starts. The bound is the base cost alone, which
    /// needs no views, if no goal can be reached from the starts, or if the uncertainty at the
    /// starts adds little and `wellObserved` is set.
    /// @param wellObserved whether the last path cost little more than its base cost
    /// @return false if the condition has ended it before: there is no bound yet
    bool update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                const std::vector<Vertex*>& goals, BeliefModel& model,
                const std::vector<Start>& starts, bool wellObserved,
                const ompl::base::PlannerTerminationCondition& ptc);

    /// Least sum of base costs from a vertex to a goal.
    double baseCost(const Vertex& vertex) const { return baseCost_[vertex.index]; }

    /// Conditional variance of each position coordinate (axes of the world) given all other
    /// coordinates of the belief [m^2]; neither motion nor uninformative views reduce it.
    static constexpr int kPositionAxes = 3;
    using PerAxis = std::array<double, kPositionAxes>;
    PerAxis variances(const Matrix6& covariance) const;

    /// Lower bound on the cost from a vertex to a goal; infinite if no goal can be reached.
    /// @param variance variances() of the belief at the vertex
    double from(const Vertex& vertex, const PerAxis& variance) const;

    /// Lower bound on the cost from a vertex to a goal if the path begins with this edge.
    double over(const Roadmap::Edge& edge, const Vertex& vertex, const PerAxis& variance) const;

    /// Length of the shortest path from a vertex to a goal over edges not known to be blocked,
    /// metric of the flight space [m].
    double distance(const Vertex& vertex) const { return toGoal_[vertex.index]; }

  private:
    using Observed = std::array<bool, kPositionAxes>;  // whether a view informs about an axis

    const Vertex* evaluatedNear(const Roadmap& roadmap, const Vertex& vertex) const;
    Observed observedFrom(const Vertex& vertex) const;
    double baseCostOf(const Roadmap::Edge& edge) const;
    void findBaseCosts(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                       const std::vector<Vertex*>& goals, BeliefModel& model);
    bool findObserved(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                      const ompl::base::PlannerTerminationCondition& ptc);
    bool reachesGoal(const Start& start) const {
        return baseCost_[start.vertex->index] < kInfinity;
    }
    bool isUncertain(const Start& start) const;
    void findViews(const Roadmap& roadmap, const std::deque<Vertex>& vertices, int axis);
    bool observes(const Roadmap::Edge& edge, int axis) const {
        return observes_[edge.from->index][axis] || observes_[edge.to->index][axis];
    }

    BeliefModel* model_ = nullptr;
    double charge_ = 0.;              // per metre and m^2
    std::vector<double> toGoal_;      // by vertex: distance
    std::vector<double> baseCost_;    // by vertex: least sum of base costs to a goal
    std::vector<Observed> observes_;  // by vertex
    std::vector<bool> isEvaluated_;   // by vertex; else it observes what a near one does
    std::array<std::vector<double>, kPositionAxes>
        toView_;  // by vertex: distance to a view of the axis
    std::array<std::vector<double>, kPositionAxes>
        viaView_;  // by vertex: base costs to the goal by there
};

}  // namespace photonav
