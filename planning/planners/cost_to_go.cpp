// SPDX-License-Identifier: BSD-3-Clause
#include "planners/cost_to_go.hpp"

#include <algorithm>
#include <functional>
#include <queue>

#include "geometry/constants.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr double kMinInformation = 1e-6;  // a coordinate known to 1 km is not observed [1/m^2]
constexpr double kRounding = 1e-9;        // of the best observed axis: rounding of grey levels
constexpr double kSafety = 0.99;          // factor on the charge
constexpr double kLittleCharge = 0.05;    // of the base cost: not worth a view from every vertex

double lengthOf(const Roadmap::Edge& edge) { return edge.motion.length; }

/// Dijkstra's algorithm from the values that `distance` holds already.
template <typename Weight>
void findDistances(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                   std::vector<double>& distance, const Weight& weightOf) {
    using Entry = std::pair<double, const Vertex*>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (const Vertex& vertex : vertices) {
        if (distance[vertex.index] < kInfinity) open.emplace(distance[vertex.index], &vertex);
    }
    while (!open.empty()) {
        const auto [length, vertex] = open.top();
        open.pop();
        if (length > distance[vertex->index]) continue;
        for (const Roadmap::Edge* edge : roadmap.of(vertex)) {
            if (!edge->isFree.value_or(true)) continue;
            double& next = distance[edge->otherEnd(vertex)->index];
            const double arrival = length + weightOf(*edge);
            if (arrival >= next) continue;
            next = arrival;
            open.emplace(next, edge->otherEnd(vertex));
        }
    }
}

}  // namespace

void CostToGo::update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                      const std::vector<Vertex*>& goals, BeliefModel& model) {
    findBaseCosts(roadmap, vertices, goals, model);
    if (charge_ > 0.) findObserved(roadmap, vertices, ob::plannerNonTerminatingCondition());
}

bool CostToGo::update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                      const std::vector<Vertex*>& goals, BeliefModel& model,
                      const std::vector<Start>& starts, bool wellObserved,
                      const ob::PlannerTerminationCondition& ptc) {
    findBaseCosts(roadmap, vertices, goals, model);
    const bool needsViews = std::any_of(starts.begin(), starts.end(), [&](const Start& start) {
        return reachesGoal(start) && (!wellObserved || isUncertain(start));
    });
    if (!needsViews) charge_ = 0.;
    return charge_ == 0. || findObserved(roadmap, vertices, ptc);
}

void CostToGo::findBaseCosts(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                             const std::vector<Vertex*>& goals, BeliefModel& model) {
    const BeliefOptions& options = model.options();
    model_ = &model;
    const bool byCovariance = options.cost == CostRule::integral && !model.field().hasPenalties();
    charge_ = byCovariance ? kSafety * (1. - options.alpha) * options.kappa : 0.;
    const double unreached = goals.empty() ? 0. : kInfinity;
    toGoal_.assign(vertices.size(), unreached);
    for (const Vertex* goal : goals) toGoal_[goal->index] = 0.;
    baseCost_ = toGoal_;
    findDistances(roadmap, vertices, toGoal_, lengthOf);
    findDistances(roadmap, vertices, baseCost_,
                  [this](const auto& edge) { return baseCostOf(edge); });
}

bool CostToGo::findObserved(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                            const ob::PlannerTerminationCondition& ptc) {
    observes_.clear();
    isEvaluated_.clear();
    for (const Vertex& vertex : vertices) {
        if (ptc) return false;
        const bool isRemoved = vertex.state == nullptr;
        const Vertex* near = isRemoved ? nullptr : evaluatedNear(roadmap, vertex);
        isEvaluated_.push_back(!isRemoved && near == nullptr);
        if (isRemoved)
            observes_.push_back({});
        else
            observes_.push_back(near == nullptr ? observedFrom(vertex) : observes_[near->index]);
    }
    for (int k = 0; k < kPositionAxes; ++k) findViews(roadmap, vertices, k);
    return true;
}

/// Whether the uncertainty at the start may add much to the base cost.
bool CostToGo::isUncertain(const Start& start) const {
    if (charge_ == 0.) return false;
    double sum = 0.;
    for (const double variance : variances(start.covariance)) sum += variance;
    return charge_ * sum * toGoal_[start.vertex->index] >
           kLittleCharge * baseCost_[start.vertex->index];
}

double CostToGo::baseCostOf(const Roadmap::Edge& edge) const {
    return model_->lowerBound(edge.motion);
}

/// An older vertex no farther than views are apart, whose view was evaluated.
const Vertex* CostToGo::evaluatedNear(const Roadmap& roadmap, const Vertex& vertex) const {
    for (const Roadmap::Edge* edge : roadmap.of(&vertex)) {
        const Vertex* other = edge->otherEnd(&vertex);
        const bool isNear = edge->motion.length <= model_->options().ds;
        if (isNear && other->index < vertex.index && isEvaluated_[other->index]) return other;
    }
    return nullptr;
}

CostToGo::Observed CostToGo::observedFrom(const Vertex& vertex) const {
    const auto& view = model_->field().atAnyEpoch(model_->space().bodyPose(vertex.state));
    if (view.isStale) return {true, true, true};
    const auto information = view.information.diagonal().head<kPositionAxes>();
    const double least = std::max(kMinInformation, kRounding * information.maxCoeff());
    Observed observed{};
    for (int k = 0; k < kPositionAxes; ++k) observed[k] = information[k] > least;
    return observed;
}

void CostToGo::findViews(const Roadmap& roadmap, const std::deque<Vertex>& vertices, int axis) {
    auto& toView = toView_[axis];
    auto& viaView = viaView_[axis];
    toView.assign(vertices.size(), kInfinity);
    viaView.assign(vertices.size(), kInfinity);
    for (const Vertex& vertex : vertices) {
        for (const Roadmap::Edge* edge : roadmap.of(&vertex)) {
            const Vertex* next = edge->otherEnd(&vertex);
            if (!edge->isFree.value_or(true)) continue;
            if (!observes(*edge, axis)) continue;
            toView[vertex.index] = 0.;
            viaView[vertex.index] =
                std::min(viaView[vertex.index], baseCostOf(*edge) + baseCost_[next->index]);
        }
    }
    findDistances(roadmap, vertices, toView, lengthOf);
    findDistances(roadmap, vertices, viaView,
                  [this](const auto& edge) { return baseCostOf(edge); });
}

double CostToGo::from(const Vertex& vertex, const PerAxis& variance) const {
    const double length = toGoal_[vertex.index];
    const double base = baseCost_[vertex.index];
    if (charge_ == 0. || length == kInfinity) return base;
    double unobserved = 0.;  // charge until each axis is observed, on the shortest path
    double detour = 0.;      // at least as much more for one of the axes
    for (int k = 0; k < kPositionAxes; ++k) {
        const double toView = toView_[k][vertex.index];
        const double least = charge_ * variance[k] * std::min(toView, length);
        const double never = charge_ * variance[k] * length;
        const double viaView =
            toView == kInfinity ? kInfinity
                                : charge_ * variance[k] * toView + viaView_[k][vertex.index] - base;
        unobserved += least;
        detour = std::max(detour, std::min(viaView, never) - least);
    }
    return base + unobserved + detour;
}

double CostToGo::over(const Roadmap::Edge& edge, const Vertex& vertex,
                      const PerAxis& variance) const {
    PerAxis left = variance;
    double cost = baseCostOf(edge);
    if (charge_ > 0.) {
        for (int k = 0; k < kPositionAxes; ++k) {
            if (observes(edge, k)) left[k] = 0.;
            cost += charge_ * left[k] * edge.motion.length;
        }
    }
    return cost + from(*edge.otherEnd(&vertex), left);
}

CostToGo::PerAxis CostToGo::variances(const Matrix6& covariance) const {
    PerAxis variance{};
    if (charge_ == 0.) return variance;
    const Eigen::LLT<Matrix6> llt(covariance);
    if (llt.info() != Eigen::Success) return variance;
    const Matrix6 precision = llt.solve(Matrix6::Identity());
    for (int k = 0; k < kPositionAxes; ++k) variance[k] = 1. / precision(k, k);
    return variance;
}

}  // namespace photonav
