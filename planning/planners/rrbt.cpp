// SPDX-License-Identifier: BSD-3-Clause
#include "planners/rrbt.hpp"

#include <algorithm>

#include "geometry/loewner_order.hpp"

namespace photonav {
namespace ob = ompl::base;

RRBT::RRBT(const ob::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
           const GrowthOptions& growth, double epsilon)
    : BeliefPlanner(si, std::move(model), "rrbt", growth), epsilon_(epsilon) {
    declareOption("epsilon", epsilon_);
    addPlannerProgressProperty("beliefs INTEGER", [this] { return std::to_string(beliefs()); });
}

void RRBT::addRoot(const Root& root) {
    roadmap_.resize(vertices_.size());
    nodesOf_.resize(vertices_.size());
    nodesOf_[root.vertex->index].push_back(
        &nodes_.emplace_back(Node{root.vertex, nullptr, root.belief}));
    ++beliefs_;
}

/// The body of the paper's Algorithm 1 after the new vertex has been found.
void RRBT::connect(Vertex& fresh, const std::vector<Vertex*>& near,
                   const ob::PlannerTerminationCondition& ptc) {
    nodesOf_.resize(vertices_.size());
    for (Vertex* vertex : near) {
        Roadmap::Edge& edge =
            roadmap_.add(vertex, &fresh, model_->motion(vertex->state, fresh.state));
        if (vertex == near.front()) edge.isFree = true;
        if (!Roadmap::isFree(edge, *si_)) continue;
        const std::vector<Node*> known = nodesOf_[vertex->index];
        for (Node* node : known) {
            if (!node->isRemoved) propagateOver(*node, edge);
        }
    }
    propagateQueue(ptc);
}

void RRBT::propagateQueue(const ob::PlannerTerminationCondition& ptc) {
    const auto costsMore = [](const Node* a, const Node* b) {
        return a->belief.cost > b->belief.cost;
    };
    while (!queue_.empty() && !ptc) {
        std::pop_heap(queue_.begin(), queue_.end(), costsMore);
        Node& node = *queue_.back();
        queue_.pop_back();
        try {
            propagateFrom(node);
        } catch (...) {  // a view: the rest of its edges follows in the next solve()
            enqueue(node);
            throw;
        }
    }
}

void RRBT::propagateFrom(Node& node) {
    for (Roadmap::Edge* edge : roadmap_.of(node.vertex)) {
        if (node.isRemoved) break;
        if (Roadmap::isFree(*edge, *si_)) propagateOver(node, *edge);
    }
}

void RRBT::propagateOver(Node& node, Roadmap::Edge& edge) {
    const bool backward = edge.to == node.vertex;
    appendBelief(*edge.otherEnd(node.vertex), node,
                 model_->propagate(node.belief, edge.motion, backward));
}

/// The paper's AppendBelief.
void RRBT::appendBelief(Vertex& vertex, Node& parent, const Belief& belief) {
    auto& known = nodesOf_[vertex.index];
    for (const Node* node : known) {
        if (isAtLeastAsGood(node->belief, belief, epsilon_)) return;
    }
    const std::vector<Node*> before = known;
    for (Node* node : before) {
        // Strictly cheaper, so that a node never removes its own ancestor.
        const bool isCheaper = belief.cost < node->belief.cost;
        if (isCheaper && !node->isRemoved && isAtLeastAsGood(belief, node->belief, 0.)) {
            remove(*node);
        }
    }
    Node& node = nodes_.emplace_back(Node{&vertex, &parent, belief});
    parent.children.push_back(&node);
    known.push_back(&node);
    ++beliefs_;
    enqueue(node);
    if (vertex.isGoal && belief.cost < bestCost()) offerPath(node);
}

bool RRBT::isAtLeastAsGood(const Belief& a, const Belief& b, double epsilon) const {
    if (a.cost > b.cost) return false;
    const double L = model_->options().characteristicLength;
    // Equal beliefs are at least as good as each other in spite of rounding.
    const double slack = epsilon + 1e-12 * b.covariance.trace();
    Matrix6 limit = b.covariance;
    limit.diagonal().head<3>().array() += slack;
    limit.diagonal().tail<3>().array() += L > 0. ? slack / (L * L) : slack;
    return isLoewnerLess(a.covariance, limit);
}

/// Removes a node and all its descendants.
void RRBT::remove(Node& node) {
    std::erase(node.parent->children, &node);
    std::vector<Node*> open{&node};
    while (!open.empty()) {
        Node* next = open.back();
        open.pop_back();
        next->isRemoved = true;
        std::erase(nodesOf_[next->vertex->index], next);
        --beliefs_;
        open.insert(open.end(), next->children.begin(), next->children.end());
        next->children.clear();
    }
}

void RRBT::enqueue(Node& node) {
    queue_.push_back(&node);
    std::push_heap(queue_.begin(), queue_.end(),
                   [](const Node* a, const Node* b) { return a->belief.cost > b->belief.cost; });
}

void RRBT::offerPath(const Node& goal) {
    std::vector<const ob::State*> path;
    for (const Node* node = &goal; node != nullptr; node = node->parent) {
        path.push_back(node->vertex->state);
    }
    std::reverse(path.begin(), path.end());
    offer(goal.belief.cost, path);
}

BeliefPlanner::Invalid RRBT::invalidate(const ChangedSpace& changed,
                                        std::vector<Vertex*> colliding) {
    return {std::move(colliding), roadmap_.mapChanged(changed, model_->space(), *si_)};
}

std::vector<const Vertex*> RRBT::parents() const {
    std::vector<const Vertex*> parents(nodesOf_.size(), nullptr);
    for (std::size_t i = 0; i < nodesOf_.size(); ++i) {
        const Node* best = nullptr;
        for (const Node* node : nodesOf_[i]) {
            if (best == nullptr || node->belief.cost < best->belief.cost) best = node;
        }
        if (best != nullptr && best->parent != nullptr) parents[i] = best->parent->vertex;
    }
    return parents;
}

/// All beliefs are propagated anew over the graph, when solve() is called next.
void RRBT::renewBeliefs() {
    nodes_.clear();
    nodesOf_.assign(vertices_.size(), {});
    queue_.clear();
    beliefs_ = 0;
    for (const Root& root : roots_) {
        addRoot(root);
        enqueue(nodes_.back());
    }
}

std::vector<Vertex*> RRBT::replaceRoots(const Root& root, const std::vector<Vertex*>& near) {
    for (Vertex* vertex : near) {
        roadmap_.add(root.vertex, vertex, model_->motion(root.vertex->state, vertex->state));
    }
    renewBeliefs();
    return {};
}

void RRBT::clear() {
    BeliefPlanner::clear();
    roadmap_.clear();
    nodes_.clear();
    nodesOf_.clear();
    queue_.clear();
    beliefs_ = 0;
}

std::vector<TreeNode> RRBT::tree() const {
    std::vector<TreeNode> nodes;
    std::vector<std::pair<const Node*, int>> open;
    for (const Root& root : roots_) {
        for (const Node* node : nodesOf_[root.vertex->index]) {
            if (node->parent == nullptr) open.emplace_back(node, -1);
        }
    }
    while (!open.empty()) {
        const auto [node, parent] = open.back();
        open.pop_back();
        const ob::State* state = node->vertex->state;
        nodes.push_back(
            {state, parent, node->belief.cost, model_->cameraCovariance(state, node->belief)});
        const int self = static_cast<int>(nodes.size()) - 1;
        for (const Node* child : node->children) open.emplace_back(child, self);
    }
    return nodes;
}

}  // namespace photonav
