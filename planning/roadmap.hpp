// SPDX-License-Identifier: BSD-3-Clause
// A graph over a planner's vertices: every motion that may be worth flying, in both directions.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "belief_planner.hpp"

namespace photonav {

class Roadmap {
  public:
    struct Edge {
        Vertex* from;
        Vertex* to;
        Motion motion;               ///< remembers its views once it was flown
        std::optional<bool> isFree;  ///< nothing: not checked yet

        Vertex* otherEnd(const Vertex* end) const { return end == from ? to : from; }
    };

    Edge& add(Vertex* from, Vertex* to, Motion motion) {
        resize(1 + std::max(from->index, to->index));
        Edge& edge = edges_.emplace_back(Edge{from, to, std::move(motion), std::nullopt});
        edgesOf_[from->index].push_back(&edge);
        edgesOf_[to->index].push_back(&edge);
        return edge;
    }

    /// Edges that begin or end at a vertex.
    const std::vector<Edge*>& of(const Vertex* vertex) const { return edgesOf_[vertex->index]; }

    std::size_t size() const { return edgesOf_.size(); }  ///< number of vertices
    void resize(std::size_t vertices) {
        if (vertices > edgesOf_.size()) edgesOf_.resize(vertices);
    }
    void clear() {
        edgesOf_.clear();
        edges_.clear();
    }

  private:
    std::deque<Edge> edges_;
    std::vector<std::vector<Edge*>> edgesOf_;  // by vertex
};

}  // namespace photonav
