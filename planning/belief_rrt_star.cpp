// SPDX-License-Identifier: BSD-3-Clause
#include "belief_rrt_star.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kFirstSearch = 100;  // vertices
constexpr std::size_t kSearchGrowth = 2;   // of the roadmap between searches

constexpr double kDominanceSlack = 0.02;  // see isDominated()
constexpr double kMinLever = 1.;          // [m]
constexpr double kMaxLever = 100.;        // [m]

}  // namespace

BeliefRRTstar::BeliefRRTstar(const ob::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                             unsigned labels, const GrowthOptions& growth)
    : BeliefPlanner(si, std::move(model), "belief_rrt_star", growth), maxLabels_(labels) {
    params_.declareParam<unsigned>(
        "labels", [this](unsigned v) { maxLabels_ = v; }, [this] { return maxLabels_; });
}

void BeliefRRTstar::connect(Vertex& fresh, const std::vector<Vertex*>& near,
                            const ob::PlannerTerminationCondition& ptc) {
    edgesOf_.resize(vertices_.size());
    for (Vertex* vertex : near) {
        Edge& edge = edges_.emplace_back(
            Edge{vertex, &fresh, model_->motion(vertex->state, fresh.state), std::nullopt});
        edgesOf_[vertex->index].push_back(&edge);
        edgesOf_[fresh.index].push_back(&edge);
    }
    edgesOf_[fresh.index].front()->isFree = true;
    const std::size_t due = std::max(kFirstSearch, kSearchGrowth * searched_);
    if (!goals_.empty() && vertices_.size() >= due) search(ptc);
}

void BeliefRRTstar::finish(const ob::PlannerTerminationCondition& ptc) {
    if (vertices_.size() > searched_) search(ptc);
}

/// Best-first over labels (vertex, belief). Costs only grow along a path, so labels settle at each
/// vertex in the order of their cost, and the first one at a goal is the best that the labels kept
/// can give.
void BeliefRRTstar::search(const ob::PlannerTerminationCondition& ptc) {
    edgesOf_.resize(vertices_.size());
    settled_.clear();
    labelsOf_.assign(vertices_.size(), {});

    const auto toGoal = distancesToGoal();
    const auto later = [](const auto& a, const auto& b) { return a->bound > b->bound; };
    Open open;
    for (Vertex* start : starts_) {
        if (!std::isfinite(toGoal[start->index])) continue;
        const double bound = model_->lowerBound(toGoal[start->index]);
        open.push_back(std::make_unique<Label>(Label{start, -1, start->belief, bound}));
    }
    std::make_heap(open.begin(), open.end(), later);
    while (!open.empty()) {
        if (ptc) return;
        std::pop_heap(open.begin(), open.end(), later);
        const auto label = std::move(open.back());
        open.pop_back();
        auto& labels = labelsOf_[label->vertex->index];
        if (labels.size() >= maxLabels_) continue;
        const double rest = toGoal[label->vertex->index];
        if (isDominated(*label->vertex, label->belief.covariance, rest)) continue;
        labels.push_back(static_cast<int>(settled_.size()));
        settled_.push_back(*label);
        if (label->vertex->isGoal) {
            offerPath(labels.back());
            break;
        }
        expand(labels.back(), toGoal, open);
    }
    searched_ = vertices_.size();
}

/// Shortest way to a goal over edges not known to be blocked: times alpha, what no belief can beat.
std::vector<double> BeliefRRTstar::distancesToGoal() const {
    if (goals_.empty()) return std::vector<double>(vertices_.size(), 0.);
    std::vector<double> distance(vertices_.size(), kInfinity);
    using Entry = std::pair<double, const Vertex*>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (const Vertex* goal : goals_) {
        distance[goal->index] = 0.;
        open.emplace(0., goal);
    }
    while (!open.empty()) {
        const auto [way, vertex] = open.top();
        open.pop();
        if (way > distance[vertex->index]) continue;
        for (const Edge* edge : edgesOf_[vertex->index]) {
            if (!edge->isFree.value_or(true)) continue;
            const Vertex* next = edge->from == vertex ? edge->to : edge->from;
            if (way + edge->motion.length >= distance[next->index]) continue;
            distance[next->index] = way + edge->motion.length;
            open.emplace(distance[next->index], next);
        }
    }
    return distance;
}

void BeliefRRTstar::expand(int label, const std::vector<double>& toGoal, Open& open) {
    const auto later = [](const auto& a, const auto& b) { return a->bound > b->bound; };
    const Vertex* vertex = settled_[label].vertex;
    const Belief& belief = settled_[label].belief;
    const double limit = bestCost() * (1. + 1e-12);  // finds the best path known so far again
    for (Edge* edge : edgesOf_[vertex->index]) {
        const bool backward = edge->to == vertex;
        Vertex* next = backward ? edge->from : edge->to;
        if (labelsOf_[next->index].size() >= maxLabels_) continue;
        const double rest = toGoal[next->index];
        if (!std::isfinite(rest)) continue;
        if (belief.cost + model_->lowerBound(edge->motion.length + rest) > limit) continue;
        if (!edge->isFree) edge->isFree = motionIsFree(*edge->from, *edge->to);
        if (!*edge->isFree) continue;

        const Belief arrival = model_->fly(belief, edge->motion, backward);
        const double bound = arrival.cost + model_->lowerBound(rest);
        if (bound > limit || isDominated(*next, arrival.covariance, rest)) continue;
        open.push_back(std::make_unique<Label>(Label{next, label, arrival, bound}));
        std::push_heap(open.begin(), open.end(), later);
    }
}

/// Labels settled earlier cost less, so the covariance decides: dominated is what is nowhere better
/// by more than the slack, neither relative to itself nor to the whole. Without the second part a
/// label lives on for a hair less roll, and near-copies crowd out the one that matters. A rotation
/// error counts by what it will do to the position on the way to the goal.
bool BeliefRRTstar::isDominated(const Vertex& vertex, const Matrix6& covariance,
                                double toGoal) const {
    const double lever = std::clamp(toGoal, kMinLever, kMaxLever);
    Matrix6 limit = (1. + kDominanceSlack) * covariance;
    const double whole = kDominanceSlack * weightedTrace(covariance, lever);
    limit.diagonal().head<3>().array() += whole;
    limit.diagonal().tail<3>().array() += whole / (lever * lever);
    for (const int label : labelsOf_[vertex.index]) {
        const Matrix6 excess = limit - settled_[label].belief.covariance;
        if ((excess.diagonal().array() < 0.).any()) continue;
        if (excess.llt().info() == Eigen::Success) return true;
    }
    return false;
}

void BeliefRRTstar::offerPath(int label) {
    const double cost = settled_[label].belief.cost;
    std::vector<const ob::State*> path;
    for (; label >= 0; label = settled_[label].parent) {
        path.push_back(settled_[label].vertex->state);
    }
    std::reverse(path.begin(), path.end());
    offer(cost, path);
}

void BeliefRRTstar::clear() {
    BeliefPlanner::clear();
    edges_.clear();
    edgesOf_.clear();
    settled_.clear();
    labelsOf_.clear();
    searched_ = 0;
}

std::vector<TreeNode> BeliefRRTstar::tree() const {
    std::vector<TreeNode> nodes;
    nodes.reserve(settled_.size());
    for (const Label& label : settled_) {
        nodes.push_back(
            {label.vertex->state, label.parent, label.belief.cost, label.belief.covariance});
    }
    return nodes;
}

}  // namespace photonav
