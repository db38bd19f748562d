// SPDX-License-Identifier: BSD-3-Clause
#include "perception_rrt_star.hpp"

#include <algorithm>

#include "constants.hpp"

namespace photonav {

PerceptionRRTstar::PerceptionRRTstar(const ompl::base::SpaceInformationPtr& si,
                                     const std::shared_ptr<BeliefModel>& model,
                                     const GrowthOptions& growth)
    : BeliefPlanner(si, model, model->options().alpha == 1. ? "rrt_star" : "pa_rrt_star", growth),
      shortestPath_(model->options().alpha == 1.) {}

void PerceptionRRTstar::connect(Vertex& fresh, const std::vector<Vertex*>& near,
                                const ompl::base::PlannerTerminationCondition&) {
    std::vector<Candidate> candidates;
    candidates.reserve(near.size());
    for (Vertex* vertex : near) {
        candidates.push_back({vertex, model_->motion(vertex->state, fresh.state), std::nullopt});
    }
    candidates.front().isFree = true;
    const auto bound = [&](const Candidate& c) {
        return c.vertex->belief.cost + model_->lowerBound(c.motion.length);
    };
    std::sort(candidates.begin(), candidates.end(),
              [&](const Candidate& a, const Candidate& b) { return bound(a) < bound(b); });
    chooseParent(fresh, candidates);
    rewire(fresh, candidates);
    offerBestGoal();
}

/// Lines 6 to 24 of Algorithm 1. Candidates come in the order of a bound on what they can give, so
/// the first that cannot improve ends the search.
void PerceptionRRTstar::chooseParent(Vertex& fresh, std::vector<Candidate>& candidates) {
    fresh.belief.cost = kInfinity;
    const Candidate* best = nullptr;
    for (Candidate& candidate : candidates) {
        const Belief& belief = candidate.vertex->belief;
        if (belief.cost + model_->lowerBound(candidate.motion.length) >= fresh.belief.cost) break;
        if (!isFree(candidate, fresh)) continue;
        const Belief arrival = fly(belief, candidate.motion, false);
        if (arrival.cost >= fresh.belief.cost) continue;
        fresh.belief = arrival;
        best = &candidate;
    }
    fresh.parent = best->vertex;
    fresh.motion = best->motion;
    fresh.backward = false;
    fresh.parent->children.push_back(&fresh);
}

/// Line 25 of Algorithm 1: neighbours that are reached at less cost through the new vertex.
void PerceptionRRTstar::rewire(Vertex& fresh, std::vector<Candidate>& candidates) {
    for (Candidate& candidate : candidates) {
        Vertex& vertex = *candidate.vertex;
        if (&vertex == fresh.parent) continue;
        if (fresh.belief.cost + model_->lowerBound(candidate.motion.length) >= vertex.belief.cost) {
            continue;
        }
        if (!isFree(candidate, fresh)) continue;
        const Belief arrival = fly(fresh.belief, candidate.motion, true);
        if (arrival.cost >= vertex.belief.cost) continue;
        std::erase(vertex.parent->children, &vertex);
        vertex.parent = &fresh;
        vertex.motion = std::move(candidate.motion);
        vertex.backward = true;
        vertex.belief = arrival;
        fresh.children.push_back(&vertex);
        updateSubtree(vertex);
    }
}

/// Brings the beliefs of all descendants up to date. Their cost can rise: a cheaper way to a vertex
/// may arrive there with a poorer covariance.
void PerceptionRRTstar::updateSubtree(Vertex& root) {
    std::vector<Vertex*> open{&root};
    while (!open.empty()) {
        Vertex* vertex = open.back();
        open.pop_back();
        for (Vertex* child : vertex->children) {
            child->belief = fly(vertex->belief, child->motion, child->backward);
            open.push_back(child);
        }
    }
}

void PerceptionRRTstar::offerBestGoal() {
    for (const Vertex* goal : goals_) {
        if (goal->belief.cost >= bestCost()) continue;
        std::vector<const ompl::base::State*> path;
        for (const Vertex* v = goal; v != nullptr; v = v->parent) path.push_back(v->state);
        std::reverse(path.begin(), path.end());
        offer(goal->belief.cost, path);
    }
}

Belief PerceptionRRTstar::fly(const Belief& belief, Motion& motion, bool backward) {
    if (!shortestPath_) return model_->fly(belief, motion, backward);
    return {belief.covariance, belief.cost + motion.length};
}

bool PerceptionRRTstar::isFree(Candidate& candidate, const Vertex& fresh) const {
    if (!candidate.isFree) candidate.isFree = motionIsFree(*candidate.vertex, fresh);
    return *candidate.isFree;
}

std::vector<TreeNode> PerceptionRRTstar::tree() const {
    std::vector<TreeNode> nodes;
    std::vector<std::pair<const Vertex*, int>> open;
    for (const Vertex* start : starts_) open.emplace_back(start, -1);
    while (!open.empty()) {
        const auto [vertex, parent] = open.back();
        open.pop_back();
        nodes.push_back({vertex->state, parent, vertex->belief.cost, std::nullopt});
        if (!shortestPath_) nodes.back().covariance = vertex->belief.covariance;
        const int self = static_cast<int>(nodes.size()) - 1;
        for (const Vertex* child : vertex->children) open.emplace_back(child, self);
    }
    return nodes;
}

}  // namespace photonav
