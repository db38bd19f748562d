// SPDX-License-Identifier: BSD-3-Clause
// A lower bound on the cost-to-go of a belief over a roadmap: the heuristic of the search.
#pragma once

#include <array>

#include "geometry/constants.hpp"

#include "planners/roadmap.hpp"

namespace photonav {

/// A lower bound on the cost-to-go over a roadmap, the sum of two parts.
///
/// The base cost: what a motion costs however certain the pose is before it. Its length counts
/// alpha, and the noise of a step is in the covariance at the end of the step, before the next
/// view, so that it is charged over half the step. Where views inform nearly everywhere the cost is
/// hardly more.
///
/// The uncertainty at the start: the conditional variance of a position coordinate given all others
/// (the inverse of the precision's diagonal) never falls with motion, and only a view that observes
/// the coordinate lowers it. So it is charged at least until
/// the nearest place with such a view, and a path by way of this place has to go on to the goal
/// from there.
///
/// Views not taken yet are guessed from those at the two ends of the motion: if neither end
/// observes an axis, no view between them is assumed to. The bound can be too high where a texture
/// lies between the vertices and is visible from none of them; it becomes right as motions get
/// shorter. Of a view that the map has changed since, everything is assumed to be observed.
/// Fourth-order terms and information below the threshold are covered by 1 % of the charge.
class CostToGo {
  public:
    /// Where a search begins, and with which covariance.
    struct Start {
        const Vertex* vertex;
        Matrix6 covariance;
    };

    /// Computes the bound for a roadmap as it is now, and as the field's views are now. Evaluates
    /// the views from vertices that were never evaluated, but skips vertices within `ds` of one
    /// that was. Renders no view again.
    void update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                const std::vector<Vertex*>& goals, BeliefModel& model);

    /// The same for a search from these starts. If no goal can be reached from them, or the
    /// uncertainty there adds little and the last path was `wellObserved`, the bound is the base
    /// cost alone, which needs no views.
    void update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                const std::vector<Vertex*>& goals, BeliefModel& model,
                const std::vector<Start>& starts, bool wellObserved);

    /// Least sum of base costs from a vertex to a goal.
    double baseCost(const Vertex& vertex) const { return baseCost_[vertex.index]; }

    /// Conditional variance of each position coordinate (axes of the world) given all other
    /// coordinates of the belief [m^2]; neither motion nor uninformative views reduce it.
    static constexpr int kAxes = 3;
    using PerAxis = std::array<double, kAxes>;
    PerAxis variances(const Matrix6& covariance) const;

    /// Least cost from a vertex to a goal. Infinity where no goal can be reached.
    double from(const Vertex& vertex, const PerAxis& variance) const;

    /// Least cost from a vertex to a goal if the path begins with this edge.
    double over(const Roadmap::Edge& edge, const Vertex& vertex, const PerAxis& variance) const;

    /// Shortest path to a goal over edges not known to be blocked [m].
    double distance(const Vertex& vertex) const { return toGoal_[vertex.index]; }

  private:
    using Observed = std::array<bool, kAxes>;  // whether a view informs about an axis

    const Vertex* evaluatedNear(const Roadmap& roadmap, const Vertex& vertex) const;
    Observed observedFrom(const Vertex& vertex) const;
    double baseCostOf(const Roadmap::Edge& edge) const;
    void findBaseCosts(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                       const std::vector<Vertex*>& goals, BeliefModel& model);
    void findObserved(const Roadmap& roadmap, const std::deque<Vertex>& vertices);
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
    std::array<std::vector<double>, kAxes> toView_;   // by vertex: distance to a view of the axis
    std::array<std::vector<double>, kAxes> viaView_;  // by vertex: base costs to the goal by there
};

}  // namespace photonav
