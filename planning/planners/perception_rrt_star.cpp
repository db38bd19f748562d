// SPDX-License-Identifier: BSD-3-Clause
#include "planners/perception_rrt_star.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "geometry/constants.hpp"

namespace photonav {

PerceptionRRTstar::PerceptionRRTstar(const ompl::base::SpaceInformationPtr& si,
                                     const std::shared_ptr<BeliefModel>& model,
                                     const GrowthOptions& growth, Minimises minimises)
    : BeliefPlanner(si, model, minimises == Minimises::length ? "rrt_star" : "pa_rrt_star", growth),
      shortestPath_(minimises == Minimises::length) {
    if (shortestPath_ && model->options().alpha != 1.) {
        throw std::invalid_argument("rrt_star: alpha must be 1");
    }
}

void PerceptionRRTstar::addRoot(const Root& root) {
    tree_.resize(vertices_.size());
    at(*root.vertex).belief = root.belief;
}

void PerceptionRRTstar::connect(Vertex& fresh, const std::vector<Vertex*>& near,
                                const ompl::base::PlannerTerminationCondition&) {
    tree_.resize(vertices_.size());
    auto candidates = candidatesOf(fresh, near);
    candidates.front().isFree = true;
    const auto bound = [&](const Candidate& c) {
        return belief(*c.vertex).cost + model_->lowerBound(c.motion.length);
    };
    std::sort(candidates.begin(), candidates.end(),
              [&](const Candidate& a, const Candidate& b) { return bound(a) < bound(b); });
    chooseParent(fresh, candidates);
    rewire(fresh, candidates);
    offerBestGoal();
}

std::vector<PerceptionRRTstar::Candidate> PerceptionRRTstar::candidatesOf(
    const Vertex& vertex, const std::vector<Vertex*>& near) {
    std::vector<Candidate> candidates;
    candidates.reserve(near.size());
    for (Vertex* other : near) {
        candidates.push_back({other, model_->motion(other->state, vertex.state), std::nullopt});
    }
    return candidates;
}

/// Lines 6 to 24 of Algorithm 1. Candidates are sorted by a bound on their benefit, so the first
/// that cannot improve ends the search. A vertex has a parent even if its cost is not finite.
void PerceptionRRTstar::chooseParent(Vertex& fresh, std::vector<Candidate>& candidates) {
    Branch& branch = at(fresh);
    branch.belief.cost = kInfinity;  // if a view throws, the vertex stays outside of the tree
    Belief reached;
    const Candidate* best = nullptr;
    for (Candidate& candidate : candidates) {
        const Belief& origin = belief(*candidate.vertex);
        const double least = origin.cost + model_->lowerBound(candidate.motion.length);
        if (best != nullptr && least >= reached.cost) break;
        if (!isFree(candidate, fresh)) continue;
        const Belief arrival = propagate(origin, candidate.motion, false);
        if (best != nullptr && arrival.cost >= reached.cost) continue;
        reached = arrival;
        best = &candidate;
    }
    branch.belief = reached;
    branch.parent = best->vertex;
    branch.motion = best->motion;
    at(*branch.parent).children.push_back(&fresh);
}

/// Line 25 of Algorithm 1: neighbours that are reached at less cost through the new vertex.
void PerceptionRRTstar::rewire(Vertex& fresh, std::vector<Candidate>& candidates) {
    Branch& origin = at(fresh);
    for (Candidate& candidate : candidates) {
        Vertex& vertex = *candidate.vertex;
        Branch& branch = at(vertex);
        if (&vertex == origin.parent) continue;
        if (origin.belief.cost + model_->lowerBound(candidate.motion.length) >=
            branch.belief.cost) {
            continue;
        }
        if (!isFree(candidate, fresh)) continue;
        const Belief arrival = propagate(origin.belief, candidate.motion, true);
        if (arrival.cost >= branch.belief.cost) continue;
        updateSubtree(vertex, arrival);
        std::erase(at(*branch.parent).children, &vertex);
        branch.parent = &fresh;
        branch.motion = std::move(candidate.motion);
        branch.backward = true;
        origin.children.push_back(&vertex);
    }
}

/// Gives a vertex a belief and brings those of all descendants up to date. Their cost can rise: a
/// cheaper way to a vertex may arrive there with a poorer covariance. If a view throws, all beliefs
/// stay as they were.
void PerceptionRRTstar::updateSubtree(const Vertex& root, const Belief& belief) {
    std::vector<std::pair<Branch*, Belief>> subtree{{&at(root), belief}};
    for (std::size_t i = 0; i < subtree.size(); ++i) {
        const auto [parent, arrival] = subtree[i];
        for (const Vertex* vertex : parent->children) {
            Branch& child = at(*vertex);
            subtree.emplace_back(&child, propagate(arrival, child.motion, child.backward));
        }
    }
    for (const auto& [branch, updated] : subtree) branch->belief = updated;
}

void PerceptionRRTstar::offerBestGoal() {
    for (const Vertex* goal : goals_) {
        if (belief(*goal).cost >= bestCost()) continue;
        std::vector<const ompl::base::State*> path;
        for (const Vertex* v = goal; v != nullptr; v = at(*v).parent) path.push_back(v->state);
        std::reverse(path.begin(), path.end());
        offer(belief(*goal).cost, path);
    }
}

Belief PerceptionRRTstar::propagate(const Belief& belief, Motion& motion, bool backward) {
    if (!shortestPath_) return model_->propagate(belief, motion, backward);
    return {belief.covariance, belief.cost + motion.length};
}

bool PerceptionRRTstar::isFree(Candidate& candidate, const Vertex& fresh) const {
    if (!candidate.isFree) candidate.isFree = motionIsFree(*candidate.vertex, fresh);
    return *candidate.isFree;
}

/// Vertices and motions in collision, and their subtrees (the paper's Algorithm 2).
BeliefPlanner::Invalid PerceptionRRTstar::invalidate(const ChangedSpace& changed,
                                                     std::vector<Vertex*> colliding) {
    const FlightSpace& space = model_->space();
    std::size_t edges = 0;
    for (Vertex& vertex : vertices_) {
        if (vertex.state == nullptr || at(vertex).parent == nullptr) continue;
        const Vertex& parent = *at(vertex).parent;
        if (!changed.touches(space.position(parent.state), space.position(vertex.state))) continue;
        if (motionIsFree(parent, vertex)) continue;
        colliding.push_back(&vertex);
        ++edges;
    }
    return {withDescendants(colliding), edges};
}

std::vector<const Vertex*> PerceptionRRTstar::parents() const {
    std::vector<const Vertex*> parents;
    parents.reserve(tree_.size());
    for (const Branch& branch : tree_) parents.push_back(branch.parent);
    return parents;
}

std::vector<Vertex*> PerceptionRRTstar::withDescendants(const std::vector<Vertex*>& vertices) {
    std::vector<bool> isListed(tree_.size(), false);
    std::vector<Vertex*> all;
    const auto list = [&](Vertex* vertex) {
        if (isListed[vertex->index]) return;
        isListed[vertex->index] = true;
        all.push_back(vertex);
    };
    for (Vertex* vertex : vertices) list(vertex);
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (Vertex* child : at(*all[i]).children) list(child);
    }
    return all;
}

void PerceptionRRTstar::removeEdgesOf(const Vertex& vertex) {
    Branch& branch = at(vertex);
    if (branch.parent != nullptr) std::erase(at(*branch.parent).children, &vertex);
    for (const Vertex* child : branch.children) at(*child).parent = nullptr;
    branch = {};
    std::replace(informed_.begin(), informed_.end(), const_cast<Vertex*>(&vertex),
                 static_cast<Vertex*>(nullptr));
}

/// Line 7 of Algorithm 2 and line 9: the vertices whose information changed, by the views on the
/// motion that leads to them, get the new one. Covariances are propagated through their subtrees.
void PerceptionRRTstar::renewBeliefs() {
    for (Vertex& vertex : vertices_) {
        if (vertex.state != nullptr && hasChangedViews(at(vertex).motion)) {
            informed_.push_back(&vertex);
        }
    }
    for (const Root& root : roots_) updateSubtree(*root.vertex, root.belief);
    offerBestGoal();
}

/// Whether views on a motion have changed since its belief was propagated. A path or another
/// planner that shares the field may have rendered them again already.
bool PerceptionRRTstar::hasChangedViews(const Motion& motion) const {
    return std::any_of(motion.views.begin(), motion.views.end(), [&](const auto* view) {
        return view != nullptr && (view->isStale || view->epoch > motion.epoch);
    });
}

/// Lines 8 to 11 of Algorithm 2: rewires around every vertex whose information changed.
void PerceptionRRTstar::finish(const ompl::base::PlannerTerminationCondition& ptc) {
    while (!informed_.empty() && !ptc) {
        Vertex* const vertex = informed_.back();
        if (vertex != nullptr && at(*vertex).parent != nullptr) {
            std::vector<Vertex*> others = near(*vertex, at(*vertex).parent);
            std::erase(others, vertex);
            auto candidates = candidatesOf(*vertex, others);
            rewire(*vertex, candidates);
        }
        informed_.pop_back();
    }
    offerBestGoal();
}

/// Changes the root of the tree. If the new root reaches no vertex, it has no tree.
std::vector<Vertex*> PerceptionRRTstar::replaceRoots(const Root& root,
                                                     const std::vector<Vertex*>& near) {
    Vertex& vertex = *root.vertex;
    tree_.resize(vertices_.size());
    auto candidates = candidatesOf(vertex, near);
    if (near.empty() || attach(vertex, candidates)) reverseWayTo(vertex);
    updateSubtree(vertex, root.belief);
    std::erase_if(candidates, [&](const Candidate& c) { return at(*c.vertex).parent == nullptr; });
    rewire(vertex, candidates);
    offerBestGoal();
    return unreached(vertex);
}

/// Makes a vertex the child of the nearest candidate that it can be reached from.
bool PerceptionRRTstar::attach(Vertex& vertex, std::vector<Candidate>& candidates) {
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.motion.length < b.motion.length;
    });
    for (Candidate& candidate : candidates) {
        if (!isFree(candidate, vertex)) continue;
        Branch& branch = at(vertex);
        branch.parent = candidate.vertex;
        branch.motion = candidate.motion;
        branch.backward = false;
        at(*branch.parent).children.push_back(&vertex);
        return true;
    }
    return false;
}

/// Swaps parents and children from a vertex up to the root, which it becomes.
void PerceptionRRTstar::reverseWayTo(Vertex& root) {
    Vertex* parent = nullptr;
    Motion motion;
    bool backward = false;
    for (Vertex* vertex = &root; vertex != nullptr;) {
        Branch& branch = at(*vertex);
        Vertex* const next = std::exchange(branch.parent, parent);
        std::swap(branch.motion, motion);
        backward = !std::exchange(branch.backward, backward);
        if (next != nullptr) {
            std::erase(at(*next).children, vertex);
            branch.children.push_back(next);
        }
        parent = std::exchange(vertex, next);
    }
}

/// All vertices that are not in the tree of a root.
std::vector<Vertex*> PerceptionRRTstar::unreached(const Vertex& root) {
    std::vector<bool> isReached(tree_.size(), false);
    std::vector<const Vertex*> open{&root};
    while (!open.empty()) {
        const Vertex* vertex = open.back();
        open.pop_back();
        isReached[vertex->index] = true;
        const auto& children = at(*vertex).children;
        open.insert(open.end(), children.begin(), children.end());
    }
    std::vector<Vertex*> others;
    for (Vertex& vertex : vertices_) {
        if (vertex.state != nullptr && !isReached[vertex.index]) others.push_back(&vertex);
    }
    return others;
}

void PerceptionRRTstar::clear() {
    BeliefPlanner::clear();
    tree_.clear();
    informed_.clear();
}

std::vector<TreeNode> PerceptionRRTstar::tree() const {
    std::vector<TreeNode> nodes;
    std::vector<std::pair<const Vertex*, int>> open;
    for (const Root& root : roots_) open.emplace_back(root.vertex, -1);
    while (!open.empty()) {
        const auto [vertex, parent] = open.back();
        open.pop_back();
        const Branch& branch = tree_[vertex->index];
        nodes.push_back({vertex->state, parent, branch.belief.cost, std::nullopt});
        if (!shortestPath_) {
            nodes.back().covariance = model_->cameraCovariance(vertex->state, branch.belief);
        }
        const int self = static_cast<int>(nodes.size()) - 1;
        for (const Vertex* child : branch.children) open.emplace_back(child, self);
    }
    return nodes;
}

}  // namespace photonav
