// SPDX-License-Identifier: BSD-3-Clause
// A graph over a planner's vertices: motions that can be flown in both directions.
#pragma once

#include <ompl/base/PlannerTerminationCondition.h>

#include <deque>
#include <optional>
#include <vector>

#include "belief/belief.hpp"
#include "planners/changed_space.hpp"
#include "planners/vertex.hpp"

namespace photonav {

/// An undirected graph of motions between vertices. References to an edge are valid until the edge
/// is removed.
class Roadmap {
  public:
    struct Edge {
        Vertex* from;
        Vertex* to;
        Motion motion;               ///< stores the views of beliefs propagated along it
        std::optional<bool> isFree;  ///< none: not checked for collision yet

        Vertex* otherEnd(const Vertex* end) const { return end == from ? to : from; }
    };

    /// Adds an edge that is not checked for collision.
    Edge& add(Vertex* from, Vertex* to, Motion motion);

    /// Removes all edges that begin or end at a vertex.
    void removeEdgesOf(const Vertex& vertex);

    /// Whether an edge is free; checks it for collision when called for the first time.
    static bool isFree(Edge& edge, const ompl::base::SpaceInformation& si);

    /// Whether free edges of another vertex lead to all that this one leads to.
    bool isReplacedBy(const Vertex& other, const Vertex& vertex,
                      const ompl::base::SpaceInformation& si) const;

    /// Checks all edges that were not checked yet.
    /// @return false if the condition has ended it before
    bool checkAll(const ompl::base::SpaceInformation& si,
                  const ompl::base::PlannerTerminationCondition& ptc);

    /// Updates the edges that pass through changed space: edges that were free are checked again,
    /// edges that were in collision are marked as not checked.
    /// @return number of edges that were free and are in collision now
    std::size_t mapChanged(const ChangedSpace& changed, const FlightSpace& space,
                           const ompl::base::SpaceInformation& si);

    /// Edges that begin or end at a vertex.
    const std::vector<Edge*>& of(const Vertex* vertex) const { return edgesOf_[vertex->index]; }

    std::size_t size() const { return edgesOf_.size(); }  ///< number of vertices in its table
    /// Prepares the table for this number of vertices; it never shrinks.
    void resize(std::size_t vertices) {
        if (vertices > edgesOf_.size()) edgesOf_.resize(vertices);
    }
    void clear();

  private:
    std::deque<Edge> edges_;                   // removed ones begin nowhere
    std::vector<Edge*> removed_;               // to be used again
    std::vector<std::vector<Edge*>> edgesOf_;  // by vertex
};

}  // namespace photonav
