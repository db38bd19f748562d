// SPDX-License-Identifier: BSD-3-Clause
#include "belief_rrt_star.hpp"

#include <algorithm>
#include <cmath>

#include "constants.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr std::size_t kFirstSearch = 100;  // vertices
constexpr std::size_t kSearchGrowth = 2;   // of the roadmap between searches

constexpr double kDominanceSlack = 0.02;  // see isDominated()
constexpr double kMinLever = 1.;          // [m]
constexpr double kMaxLever = 100.;        // [m]

}  // namespace

BeliefRRTstar::BeliefRRTstar(const ob::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                             const SearchOptions& search, const GrowthOptions& growth)
    : BeliefPlanner(si, std::move(model), "belief_rrt_star", growth), options_(search) {
    const auto declare = [this](const std::string& key, auto& value) {
        using T = std::decay_t<decltype(value)>;
        params_.declareParam<T>(
            key, [&value](T v) { value = v; }, [&value] { return value; });
    };
    declare("labels", options_.labels);
    declare("informed", options_.informed);
    declare("shortcut", options_.shortcut);
    addPlannerProgressProperty("shortcuts tried INTEGER",
                               [this] { return std::to_string(shortcutsTried_); });
    addPlannerProgressProperty("shortcuts taken INTEGER",
                               [this] { return std::to_string(shortcutsTaken_); });
}

void BeliefRRTstar::connect(Vertex& fresh, const std::vector<Vertex*>& near,
                            const ob::PlannerTerminationCondition& ptc) {
    for (Vertex* vertex : near) {
        roadmap_.add(vertex, &fresh, model_->motion(vertex->state, fresh.state));
    }
    roadmap_.of(&fresh).front()->isFree = true;
    const std::size_t due = std::max(kFirstSearch, kSearchGrowth * searched_);
    if (goals_.empty() || vertices_.size() < due) return;
    search(ptc);
    promising_.assign(vertices_.size(), false);
    for (const Label& label : settled_) promising_[label.vertex->index] = true;
}

/// Beside a vertex that the last search found on a path which might still have been the best, or
/// beside a younger one.
bool BeliefRRTstar::isPromising(const Vertex& nearest) {
    return !options_.informed || nearest.index >= promising_.size() || promising_[nearest.index];
}

void BeliefRRTstar::finish(const ob::PlannerTerminationCondition& ptc) {
    if (vertices_.size() > searched_) search(ptc);
    if (options_.shortcut > 0 && !path_.empty()) shortenBest(ptc);
}

/// Best-first over labels (vertex, belief). No label costs more than its bound says, so the first
/// one that settles at a goal is the best that the labels kept can give.
void BeliefRRTstar::search(const ob::PlannerTerminationCondition& ptc) {
    roadmap_.resize(vertices_.size());
    settled_.clear();
    labelsOf_.assign(vertices_.size(), {});
    toGo_.update(roadmap_, vertices_, goals_, *model_);

    Open open;
    for (Vertex* start : starts_) {
        Candidate root{0., -1, nullptr, start};
        root.belief = std::make_unique<Belief>(start->belief);
        push(open, std::move(root));
    }
    while (!open.empty()) {
        if (ptc) return;
        std::pop_heap(open.begin(), open.end());
        Candidate candidate = std::move(open.back());
        open.pop_back();
        if (isFull(*candidate.vertex)) continue;
        if (candidate.belief == nullptr) {
            if (fly(candidate)) push(open, std::move(candidate));
            continue;
        }
        if (isDominated(*candidate.vertex, *candidate.belief)) continue;
        const int label = static_cast<int>(settled_.size());
        labelsOf_[candidate.vertex->index].push_back(label);
        settled_.push_back({candidate.vertex, candidate.parent, *candidate.belief});
        if (candidate.vertex->isGoal) {
            keepPath(label);
            break;
        }
        expand(label, open);
    }
    searched_ = vertices_.size();
}

void BeliefRRTstar::push(Open& open, Candidate candidate) const {
    if (!(candidate.bound <= limit())) return;
    open.push_back(std::move(candidate));
    std::push_heap(open.begin(), open.end());
}

void BeliefRRTstar::expand(int label, Open& open) const {
    const auto& [vertex, parent, belief] = settled_[label];
    const auto variances = toGo_.variances(*vertex, belief.covariance);
    for (Roadmap::Edge* edge : roadmap_.of(vertex)) {
        Vertex* next = edge->otherEnd(vertex);
        if (isFull(*next) || !edge->isFree.value_or(true)) continue;
        push(open, {belief.cost + toGo_.over(*edge, *vertex, variances), label, edge, next});
    }
}

/// @return whether the edge is free, and the label neither dominated nor too costly
bool BeliefRRTstar::fly(Candidate& candidate) {
    Roadmap::Edge& edge = *candidate.edge;
    if (!edge.isFree) edge.isFree = motionIsFree(*edge.from, *edge.to);
    if (!*edge.isFree) return false;
    const Vertex& vertex = *candidate.vertex;
    const Belief arrival =
        model_->fly(settled_[candidate.parent].belief, edge.motion, candidate.vertex == edge.from);
    if (isDominated(vertex, arrival)) return false;
    candidate.bound =
        arrival.cost + toGo_.from(vertex, toGo_.variances(vertex, arrival.covariance));
    candidate.belief = std::make_unique<Belief>(arrival);
    return candidate.bound <= limit();
}

/// Dominated is what costs no less than a label settled before and is nowhere better by more than
/// the slack, neither relative to itself nor to the whole. Without the second part a label lives on
/// for a hair less roll, and near-copies crowd out the one that matters. A rotation error counts by
/// what it will do to the position on the way to the goal.
bool BeliefRRTstar::isDominated(const Vertex& vertex, const Belief& belief) const {
    const double lever = std::clamp(toGo_.distance(vertex), kMinLever, kMaxLever);
    Matrix6 limit = (1. + kDominanceSlack) * belief.covariance;
    const double whole = kDominanceSlack * weightedTrace(belief.covariance, lever);
    limit.diagonal().head<3>().array() += whole;
    limit.diagonal().tail<3>().array() += whole / (lever * lever);
    for (const int label : labelsOf_[vertex.index]) {
        const Belief& known = settled_[label].belief;
        if (known.cost > belief.cost) continue;
        const Matrix6 excess = limit - known.covariance;
        if ((excess.diagonal().array() < 0.).any()) continue;
        if (excess.llt().info() == Eigen::Success) return true;
    }
    return false;
}

void BeliefRRTstar::keepPath(int label) {
    pathCost_ = settled_[label].belief.cost;
    path_.clear();
    for (; label >= 0; label = settled_[label].parent) {
        path_.push_back(settled_[label].vertex->state);
    }
    std::reverse(path_.begin(), path_.end());
    offer(pathCost_, path_);
}

void BeliefRRTstar::shortenBest(const ob::PlannerTerminationCondition& ptc) {
    PathDescent descent(si_, model_, {.moves = options_.shortcut});
    descent.begin(path_);
    descent.descend(ptc);
    shortcutsTried_ += descent.tried();
    shortcutsTaken_ += descent.accepted();
    offer(descent.cost(), descent.path());
}

void BeliefRRTstar::clear() {
    BeliefPlanner::clear();
    roadmap_.clear();
    toGo_ = {};
    settled_.clear();
    labelsOf_.clear();
    promising_.clear();
    path_.clear();
    pathCost_ = kInfinity;
    searched_ = 0;
    shortcutsTried_ = shortcutsTaken_ = 0;
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
