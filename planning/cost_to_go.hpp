// SPDX-License-Identifier: BSD-3-Clause
// What it still costs at least to reach a goal with a given belief: what a search steers by.
#pragma once

#include <array>

#include "roadmap.hpp"

namespace photonav {

/// A lower bound on the cost-to-go over a roadmap.
///
/// The way alone gives alpha times the shortest distance. Uncertainty adds to that: how well the
/// position along an axis is known when all else is (the inverse of the precision's diagonal) never
/// falls while flying, and no view lowers it that tells nothing about that axis. So it is charged
/// at least until the nearest place where something can be seen of that axis, and whoever goes
/// there has to go on to the goal from there.
///
/// Views not taken yet are guessed from those at the two ends of the motion: if neither end tells
/// about an axis, nothing between them is taken to. The bound can be too high where a texture lies
/// between the vertices, seen from none of them; it is right in the end, as motions get shorter.
/// Fourth-order terms and what counts as nothing are covered by 1 % of the charge.
class CostToGo {
  public:
    /// Looks from vertices, once, and from nowhere else: from all that lie no nearer to one looked
    /// from before than views are apart.
    void update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                const std::vector<Vertex*>& goals, BeliefModel& model);

    /// How well each coordinate of the position (axes of the world) would be known if all else were
    /// [m^2]: what no flight brings down, and no view that tells nothing about the axis.
    static constexpr int kAxes = 3;
    using PerAxis = std::array<double, kAxes>;
    PerAxis variances(const Vertex& vertex, const Matrix6& covariance) const;

    /// Least cost from a vertex to a goal. Infinity where no goal can be reached.
    double from(const Vertex& vertex, const PerAxis& variance) const;

    /// The same when the way begins with an edge, flown from `vertex`.
    double over(const Roadmap::Edge& edge, const Vertex& vertex, const PerAxis& variance) const;

    /// Shortest way to a goal over edges not known to be blocked [m].
    double distance(const Vertex& vertex) const { return toGoal_[vertex.index]; }

  private:
    using Sees = std::array<bool, kAxes>;  // something of an axis

    const Vertex* lookedFromNear(const Roadmap& roadmap, const Vertex& vertex) const;
    Sees look(const Vertex& vertex);
    void findViews(const Roadmap& roadmap, const std::deque<Vertex>& vertices, int axis);
    bool tells(const Roadmap::Edge& edge, int axis) const {
        return sees_[edge.from->index][axis] || sees_[edge.to->index][axis];
    }

    BeliefModel* model_ = nullptr;
    double alpha_ = 1.;
    double charge_ = 0.;              // per metre and m^2
    std::vector<double> toGoal_;      // by vertex
    std::vector<Sees> sees_;          // by vertex
    std::vector<bool> isLookedFrom_;  // by vertex; else it sees what another one does
    std::array<std::vector<double>, kAxes> toView_;   // by vertex: way to where it can be seen
    std::array<std::vector<double>, kAxes> viaView_;  // by vertex: way to the goal by there
};

}  // namespace photonav
