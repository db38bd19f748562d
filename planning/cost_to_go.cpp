// SPDX-License-Identifier: BSD-3-Clause
#include "cost_to_go.hpp"

#include <algorithm>
#include <functional>
#include <queue>

#include "constants.hpp"

namespace photonav {
namespace {

constexpr double kBlind = 1e-6;  // a view that tells a coordinate to 1 km tells nothing [1/m^2]
constexpr double kTrust = 0.99;  // of the charge

/// Dijkstra's algorithm from the values that `distance` holds already.
void spread(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
            std::vector<double>& distance) {
    using Entry = std::pair<double, const Vertex*>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (const Vertex& vertex : vertices) {
        if (distance[vertex.index] < kInfinity) open.emplace(distance[vertex.index], &vertex);
    }
    while (!open.empty()) {
        const auto [way, vertex] = open.top();
        open.pop();
        if (way > distance[vertex->index]) continue;
        for (const Roadmap::Edge* edge : roadmap.of(vertex)) {
            if (!edge->isFree.value_or(true)) continue;
            double& next = distance[edge->otherEnd(vertex)->index];
            if (way + edge->motion.length >= next) continue;
            next = way + edge->motion.length;
            open.emplace(next, edge->otherEnd(vertex));
        }
    }
}

/// What a view tells about a coordinate of the position, axes of the world.
double told(const Matrix6& information, const Eigen::Matrix3d& R_w_c, int axis) {
    const Eigen::Vector3d direction = R_w_c.row(axis);
    return direction.dot(information.topLeftCorner<3, 3>() * direction);
}

}  // namespace

void CostToGo::update(const Roadmap& roadmap, const std::deque<Vertex>& vertices,
                      const std::vector<Vertex*>& goals, BeliefModel& model) {
    const BeliefOptions& options = model.options();
    model_ = &model;
    alpha_ = options.alpha;
    const bool byCovariance = options.cost == CostRule::integral && !model.field().hasPenalties();
    charge_ = byCovariance ? kTrust * (1. - alpha_) * options.kappa : 0.;
    toGoal_.assign(vertices.size(), kInfinity);
    if (goals.empty()) toGoal_.assign(vertices.size(), 0.);
    for (const Vertex* goal : goals) toGoal_[goal->index] = 0.;
    spread(roadmap, vertices, toGoal_);
    if (charge_ == 0.) return;

    for (std::size_t i = sees_.size(); i < vertices.size(); ++i) {
        const Vertex* known = lookedFromNear(roadmap, vertices[i]);
        sees_.push_back(known == nullptr ? look(vertices[i]) : sees_[known->index]);
        isLookedFrom_.push_back(known == nullptr);
    }
    for (int k = 0; k < kAxes; ++k) findViews(roadmap, vertices, k);
}

/// An older vertex no farther than views are apart anyway.
const Vertex* CostToGo::lookedFromNear(const Roadmap& roadmap, const Vertex& vertex) const {
    for (const Roadmap::Edge* edge : roadmap.of(&vertex)) {
        const Vertex* other = edge->otherEnd(&vertex);
        const bool isNear = edge->motion.length <= model_->options().ds;
        if (isNear && other->index < vertex.index && isLookedFrom_[other->index]) return other;
    }
    return nullptr;
}

CostToGo::Sees CostToGo::look(const Vertex& vertex) {
    const Pose T_w_b = model_->space().bodyPose(vertex.state);
    const Matrix6& information = model_->informationAt(T_w_b);
    const Eigen::Matrix3d R_w_c = T_w_b.linear() * model_->field().mount().linear();
    Sees sees{};
    for (int k = 0; k < kAxes; ++k) sees[k] = told(information, R_w_c, k) > kBlind;
    return sees;
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
            if (!tells(*edge, axis)) continue;
            toView[vertex.index] = 0.;
            viaView[vertex.index] =
                std::min(viaView[vertex.index], edge->motion.length + toGoal_[next->index]);
        }
    }
    spread(roadmap, vertices, toView);
    spread(roadmap, vertices, viaView);
}

double CostToGo::from(const Vertex& vertex, const PerAxis& variance) const {
    const double way = toGoal_[vertex.index];
    if (charge_ == 0. || way == kInfinity) return alpha_ * way;
    double blindly = 0.;  // charge until each axis is seen, on the shortest way
    double detour = 0.;   // at least as much more for one of the axes
    for (int k = 0; k < kAxes; ++k) {
        const double toView = toView_[k][vertex.index];
        const double unseen = charge_ * variance[k] * std::min(toView, way);
        const double never = charge_ * variance[k] * way;
        const double seen = toView == kInfinity ? kInfinity
                                                : charge_ * variance[k] * toView +
                                                      alpha_ * (viaView_[k][vertex.index] - way);
        blindly += unseen;
        detour = std::max(detour, std::min(seen, never) - unseen);
    }
    return alpha_ * way + blindly + detour;
}

double CostToGo::over(const Roadmap::Edge& edge, const Vertex& vertex,
                      const PerAxis& variance) const {
    PerAxis left = variance;
    double cost = alpha_ * edge.motion.length;
    if (charge_ > 0.) {
        for (int k = 0; k < kAxes; ++k) {
            if (tells(edge, k)) left[k] = 0.;
            cost += charge_ * left[k] * edge.motion.length;
        }
    }
    return cost + from(*edge.otherEnd(&vertex), left);
}

CostToGo::PerAxis CostToGo::variances(const Vertex& vertex, const Matrix6& covariance) const {
    PerAxis variance{};
    if (charge_ == 0.) return variance;
    const Eigen::LLT<Matrix6> llt(covariance);
    if (llt.info() != Eigen::Success) return variance;
    const Matrix6 precision = llt.solve(Matrix6::Identity());
    const Eigen::Matrix3d R_w_c =
        model_->space().bodyPose(vertex.state).linear() * model_->field().mount().linear();
    for (int k = 0; k < kAxes; ++k) variance[k] = 1. / told(precision, R_w_c, k);
    return variance;
}

}  // namespace photonav
