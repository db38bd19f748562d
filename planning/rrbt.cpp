// SPDX-License-Identifier: BSD-3-Clause
#include "rrbt.hpp"

#include <algorithm>

namespace photonav {
namespace ob = ompl::base;

RRBT::RRBT(const ob::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
           const GrowthOptions& growth, double epsilon)
    : BeliefPlanner(si, std::move(model), "rrbt", growth), epsilon_(epsilon) {
    params_.declareParam<double>(
        "epsilon", [this](double v) { epsilon_ = v; }, [this] { return epsilon_; });
    addPlannerProgressProperty("beliefs INTEGER", [this] { return std::to_string(beliefs()); });
}

/// The body of the paper's Algorithm 1 after the new vertex has been found.
void RRBT::connect(Vertex& fresh, const std::vector<Vertex*>& near,
                   const ob::PlannerTerminationCondition& ptc) {
    edgesOf_.resize(vertices_.size());
    nodesOf_.resize(vertices_.size());
    addRoots();
    for (Vertex* vertex : near) {
        const bool isNearest = vertex == near.front();
        if (!isNearest && !motionIsFree(*vertex, fresh)) continue;
        GraphEdge& edge = edges_.emplace_back(
            GraphEdge{vertex, &fresh, model_->motion(vertex->state, fresh.state)});
        const std::vector<Node*> known = nodesOf_[vertex->index];
        for (Node* node : known) {
            if (!node->isRemoved) propagate(*node, edge);
        }
        edgesOf_[vertex->index].push_back(&edge);
        edgesOf_[fresh.index].push_back(&edge);
    }
    propagateQueue(ptc);
}

void RRBT::addRoots() {
    for (; roots_ < starts_.size(); ++roots_) {
        Vertex* start = starts_[roots_];
        nodesOf_[start->index].push_back(&nodes_.emplace_back(Node{start, nullptr, start->belief}));
    }
}

void RRBT::propagateQueue(const ob::PlannerTerminationCondition& ptc) {
    const auto costsMore = [](const Node* a, const Node* b) {
        return a->belief.cost > b->belief.cost;
    };
    while (!queue_.empty() && !ptc) {
        std::pop_heap(queue_.begin(), queue_.end(), costsMore);
        Node& node = *queue_.back();
        queue_.pop_back();
        for (GraphEdge* edge : edgesOf_[node.vertex->index]) {
            if (node.isRemoved) break;
            propagate(node, *edge);
        }
    }
}

void RRBT::propagate(Node& node, GraphEdge& edge) {
    const bool backward = edge.to == node.vertex;
    Vertex& next = backward ? *edge.from : *edge.to;
    appendBelief(next, node, model_->fly(node.belief, edge.motion, backward));
}

/// The paper's AppendBelief.
void RRBT::appendBelief(Vertex& vertex, Node& parent, const Belief& belief) {
    auto& known = nodesOf_[vertex.index];
    for (const Node* node : known) {
        if (isAtLeastAsGood(node->belief, belief, epsilon_)) return;
    }
    const std::vector<Node*> before = known;
    for (Node* node : before) {
        // Strictly cheaper, so that nobody removes an own ancestor.
        const bool isCheaper = belief.cost < node->belief.cost;
        if (isCheaper && !node->isRemoved && isAtLeastAsGood(belief, node->belief, 0.)) {
            remove(*node);
        }
    }
    Node& node = nodes_.emplace_back(Node{&vertex, &parent, belief});
    parent.children.push_back(&node);
    known.push_back(&node);
    enqueue(node);
    if (vertex.isGoal && belief.cost < bestCost()) offerPath(node);
}

bool RRBT::isAtLeastAsGood(const Belief& a, const Belief& b, double epsilon) const {
    if (a.cost > b.cost) return false;
    const double L = model_->options().characteristicLength;
    // Rounding must not tell beliefs apart that are the same.
    const double slack = epsilon + 1e-12 * b.covariance.trace();
    Matrix6 excess = b.covariance - a.covariance;
    excess.diagonal().head<3>().array() += slack;
    excess.diagonal().tail<3>().array() += L > 0. ? slack / (L * L) : slack;
    if ((excess.diagonal().array() < 0.).any()) return false;
    return excess.llt().info() == Eigen::Success;
}

/// With everything that follows from it.
void RRBT::remove(Node& node) {
    std::erase(node.parent->children, &node);
    std::vector<Node*> open{&node};
    while (!open.empty()) {
        Node* next = open.back();
        open.pop_back();
        next->isRemoved = true;
        std::erase(nodesOf_[next->vertex->index], next);
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

void RRBT::clear() {
    BeliefPlanner::clear();
    edges_.clear();
    edgesOf_.clear();
    nodes_.clear();
    nodesOf_.clear();
    queue_.clear();
    roots_ = 0;
}

std::size_t RRBT::beliefs() const {
    std::size_t count = 0;
    for (const auto& nodes : nodesOf_) count += nodes.size();
    return count;
}

std::vector<TreeNode> RRBT::tree() const {
    std::vector<TreeNode> nodes;
    std::vector<std::pair<const Node*, int>> open;
    for (const Vertex* start : starts_) {
        if (start->index >= nodesOf_.size()) continue;
        for (const Node* node : nodesOf_[start->index]) {
            if (node->parent == nullptr) open.emplace_back(node, -1);
        }
    }
    while (!open.empty()) {
        const auto [node, parent] = open.back();
        open.pop_back();
        nodes.push_back({node->vertex->state, parent, node->belief.cost, node->belief.covariance});
        const int self = static_cast<int>(nodes.size()) - 1;
        for (const Node* child : node->children) open.emplace_back(child, self);
    }
    return nodes;
}

}  // namespace photonav
