// SPDX-License-Identifier: BSD-3-Clause
#include "planners/roadmap.hpp"

#include <algorithm>

namespace photonav {

Roadmap::Edge& Roadmap::add(Vertex* from, Vertex* to, Motion motion) {
    resize(1 + std::max(from->index, to->index));
    if (removed_.empty()) removed_.push_back(&edges_.emplace_back());
    Edge& edge = *removed_.back();
    removed_.pop_back();
    edge = {from, to, std::move(motion), std::nullopt};
    edgesOf_[from->index].push_back(&edge);
    edgesOf_[to->index].push_back(&edge);
    return edge;
}

void Roadmap::removeEdgesOf(const Vertex& vertex) {
    if (vertex.index >= edgesOf_.size()) return;
    for (Edge* edge : edgesOf_[vertex.index]) {
        std::erase(edgesOf_[edge->otherEnd(&vertex)->index], edge);
        *edge = {};
        removed_.push_back(edge);
    }
    edgesOf_[vertex.index].clear();
}

bool Roadmap::isFree(Edge& edge, const ompl::base::SpaceInformation& si) {
    if (!edge.isFree) edge.isFree = si.checkMotion(edge.from->state, edge.to->state);
    return *edge.isFree;
}

std::size_t Roadmap::mapChanged(const ChangedSpace& changed, const FlightSpace& space,
                                const ompl::base::SpaceInformation& si) {
    std::size_t blocked = 0;
    for (Edge& edge : edges_) {
        if (edge.from == nullptr || !edge.isFree) continue;
        if (!changed.touches(space.position(edge.from->state), space.position(edge.to->state))) {
            continue;
        }
        const bool wasFree = *edge.isFree;
        edge.isFree.reset();
        if (wasFree && !isFree(edge, si)) ++blocked;
    }
    return blocked;
}

bool Roadmap::isReplacedBy(const Vertex& other, const Vertex& vertex,
                           const ompl::base::SpaceInformation& si) const {
    const auto leadsTo = [&](const Vertex* end) {
        return std::any_of(of(&other).begin(), of(&other).end(), [&](Edge* edge) {
            return edge->otherEnd(&other) == end && isFree(*edge, si);
        });
    };
    return std::all_of(of(&vertex).begin(), of(&vertex).end(), [&](const Edge* edge) {
        const Vertex* end = edge->otherEnd(&vertex);
        return end == &other || edge->isFree == false || leadsTo(end);
    });
}

bool Roadmap::checkAll(const ompl::base::SpaceInformation& si,
                       const ompl::base::PlannerTerminationCondition& ptc) {
    for (Edge& edge : edges_) {
        if (edge.from == nullptr || edge.isFree) continue;
        if (ptc) return false;
        isFree(edge, si);
    }
    return true;
}

void Roadmap::clear() {
    edgesOf_.clear();
    removed_.clear();
    edges_.clear();
}

}  // namespace photonav
