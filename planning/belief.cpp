// SPDX-License-Identifier: BSD-3-Clause
#include "belief.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "se3.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

/// Tens of thousands of views lie anywhere in memory: this one is fetched while a step is
/// compounded.
void prefetch(const InformationField::Entry& view) {
    constexpr std::size_t kCacheLine = 64;
    const auto* bytes = reinterpret_cast<const char*>(&view);
    for (std::size_t i = 0; i < sizeof(view); i += kCacheLine) __builtin_prefetch(bytes + i);
}

}  // namespace

void BeliefOptions::check() const {
    if (!(alpha >= 0. && alpha <= 1.)) throw std::invalid_argument("alpha is outside [0, 1]");
    if (!(kappa >= 0.)) throw std::invalid_argument("kappa is negative");
    if (!(ds > 0.)) throw std::invalid_argument("ds is not positive");
    if (!isCovariance(initialCovariance)) {
        throw std::invalid_argument("the initial covariance is not positive semi-definite");
    }
    if (!isCovariance(motionNoise)) {
        throw std::invalid_argument("the motion noise is not positive semi-definite");
    }
}

BeliefModel::BeliefModel(const FlightSpace& space, std::shared_ptr<InformationField> field,
                         const BeliefOptions& options)
    : space_(space), field_(std::move(field)), options_(options) {
    options_.check();
    const Matrix6 toCamera = adjoint(field_->mount().inverse());
    initialCamera_ = toCamera * options_.initialCovariance * toCamera.transpose();
    noiseCamera_ = toCamera * options_.motionNoise * toCamera.transpose();
}

Belief BeliefModel::root() const { return {initialCamera_, 0.}; }

Motion BeliefModel::motion(const ob::State* from, const ob::State* to) const {
    const double length = space_.space()->distance(from, to);
    const bool perVertex = options_.cost == CostRule::perVertex;
    const int steps =
        perVertex ? 1 : std::max(1, static_cast<int>(std::ceil(length / options_.ds - 1e-9)));
    return {from, to, length, steps, {}};
}

Belief BeliefModel::fly(const Belief& belief, Motion& motion, bool backward) {
    if (motion.views.empty()) look(motion);
    if (field_->hasPenalties()) return flyPenalised(belief, motion, backward);
    const auto start = std::chrono::steady_clock::now();
    const bool perVertex = options_.cost == CostRule::perVertex;
    const double step = motion.length / motion.steps;
    const double shareOfView = perVertex ? 1. : step / options_.ds;
    const Matrix6 noise = step * noiseCamera_;

    Matrix6 covariance = belief.covariance;
    double charge = 0.;
    double traceAfter = trace(covariance);
    Matrix6 adjointOfStep = stepAdjoint(motion, 0, backward);
    const bool turns = space_.kind() != StateKind::position;  // else all steps are the same
    for (int k = 0; k < motion.steps; ++k) {
        const auto& view = *motion.views[backward ? motion.steps - 1 - k : k + 1];
        prefetch(view);
        if (turns && k > 0) adjointOfStep = stepAdjoint(motion, k, backward);
        const auto moved = compoundCovariance(adjointOfStep, noise, covariance, options_.order);
        fallbacks_ += moved.fellBack ? 1 : 0;
        covariance = moved.covariance;
        charge += 0.5 * step * (traceAfter + trace(covariance));  // the trace before the update
        if (!view.isZero) {
            covariance = updateCovariance(covariance, shareOfView * view.information);
        }
        traceAfter = trace(covariance);
    }
    if (perVertex) charge = traceAfter;
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return {covariance, belief.cost + options_.alpha * motion.length +
                            (1. - options_.alpha) * options_.kappa * charge};
}

/// The penalty of the views in place of the trace: a motion costs the same for every belief.
Belief BeliefModel::flyPenalised(const Belief& belief, const Motion& motion, bool backward) const {
    double charge = 0.;
    if (options_.cost == CostRule::perVertex) {
        charge = penaltyAt(motion, backward ? 0 : motion.steps);
    } else {
        for (int k = 0; k <= motion.steps; ++k) {
            const bool isEnd = k == 0 || k == motion.steps;
            charge += (isEnd ? 0.5 : 1.) * motion.length / motion.steps * penaltyAt(motion, k);
        }
    }
    return {belief.covariance, belief.cost + options_.alpha * motion.length +
                                   (1. - options_.alpha) * options_.kappa * charge};
}

/// Of flying past the k-th view of a motion, in either direction.
double BeliefModel::penaltyAt(const Motion& motion, int k) const {
    if (motion.length == 0.) return motion.views[k]->penalty.base;  // no way, no parallax
    const Eigen::Vector3d t_w =
        (space_.position(motion.to) - space_.position(motion.from)) / motion.length;
    const Pose T_w_c =
        space_.poseBetween(motion.from, motion.to, static_cast<double>(k) / motion.steps) *
        field_->mount();
    return motion.views[k]->penalty.along(T_w_c.linear().transpose() * t_w);
}

void BeliefModel::look(Motion& motion) {
    std::vector<const InformationField::Entry*> views(motion.steps + 1);
    for (int k = 0; k <= motion.steps; ++k) {
        views[k] = &field_->at(
            space_.poseBetween(motion.from, motion.to, static_cast<double>(k) / motion.steps));
    }
    motion.views = std::move(views);
}

/// Ad(T_{k+1,k}) of the camera for the k-th step flown.
Matrix6 BeliefModel::stepAdjoint(const Motion& motion, int k, bool backward) const {
    if (space_.kind() == StateKind::position) {
        // The heading is fixed: the camera moves by a constant vector and does not turn.
        const Eigen::Vector3d way = space_.position(motion.to) - space_.position(motion.from);
        const Eigen::Vector3d step_w = way * ((backward ? -1. : 1.) / motion.steps);
        const Eigen::Matrix3d R_w_c =
            space_.bodyPose(motion.from).linear() * field_->mount().linear();
        Pose T_next_last = Pose::Identity();
        T_next_last.translation() = -(R_w_c.transpose() * step_w);
        return adjoint(T_next_last);
    }
    const double direction = backward ? -1. : 1.;
    const double begin = backward ? motion.steps - k : k;
    const Pose T_w_last =
        space_.poseBetween(motion.from, motion.to, begin / motion.steps) * field_->mount();
    const Pose T_w_next =
        space_.poseBetween(motion.from, motion.to, (begin + direction) / motion.steps) *
        field_->mount();
    return adjoint(T_w_next.inverse() * T_w_last);
}

std::vector<BeliefPoint> BeliefModel::evaluate(const std::vector<const ob::State*>& path) {
    std::vector<BeliefPoint> points;
    if (path.empty()) return points;
    const Pose T_w_b = space_.bodyPose(path.front());
    points.push_back({.T_w_b = T_w_b,
                      .covariance = initialCamera_,
                      .traceBefore = trace(initialCamera_),
                      .trace = trace(initialCamera_),
                      .information = field_->at(T_w_b).information,
                      .isWaypoint = true});
    for (std::size_t i = 1; i < path.size(); ++i) evaluateMotion(path[i - 1], path[i], points);
    return points;
}

void BeliefModel::evaluateMotion(const ob::State* from, const ob::State* to,
                                 std::vector<BeliefPoint>& points) {
    const Motion way = motion(from, to);
    const Pose T_c_b = field_->mount().inverse();
    const double step = way.length / way.steps;
    const bool perVertex = options_.cost == CostRule::perVertex;
    for (int k = 1; k <= way.steps; ++k) {
        const BeliefPoint last = points.back();
        if (field_->hasPenalties()) {
            points.push_back(penalisedPoint(last, way, k));
            continue;
        }
        BeliefPoint next;
        next.T_w_b = space_.poseBetween(way.from, way.to, static_cast<double>(k) / way.steps);
        const UncertainPose T_last_w{T_c_b * last.T_w_b.inverse(), last.covariance};
        const UncertainPose T_next_last{T_c_b * next.T_w_b.inverse() * T_last_w.mean.inverse(),
                                        step * noiseCamera_};
        next.covariance = compound(T_next_last, T_last_w, options_.order).covariance;
        next.traceBefore = trace(next.covariance);
        next.information = field_->at(next.T_w_b).information;
        const Matrix6 gain = (perVertex ? 1. : step / options_.ds) * next.information;
        next.covariance =
            (Matrix6::Identity() + next.covariance * gain).partialPivLu().solve(next.covariance);
        next.covariance = 0.5 * (next.covariance + next.covariance.transpose()).eval();
        next.trace = trace(next.covariance);
        next.distance = last.distance + step;
        next.length = last.length + (next.T_w_b.translation() - last.T_w_b.translation()).norm();
        const double charge = perVertex ? next.trace : 0.5 * step * (last.trace + next.traceBefore);
        next.cost =
            last.cost + options_.alpha * step + (1. - options_.alpha) * options_.kappa * charge;
        next.isWaypoint = k == way.steps;
        points.push_back(next);
    }
}

/// The k-th point of a motion, flown from `last`: the belief stays, the penalty is charged.
BeliefPoint BeliefModel::penalisedPoint(const BeliefPoint& last, const Motion& motion, int k) {
    BeliefPoint next = last;
    next.T_w_b = space_.poseBetween(motion.from, motion.to, static_cast<double>(k) / motion.steps);
    const double step = motion.length / motion.steps;
    const Eigen::Vector3d way_w = next.T_w_b.translation() - last.T_w_b.translation();
    const auto penalty = [&](const Pose& T_w_b) {
        const Eigen::Vector3d t_w = step > 0. ? way_w / step : way_w;
        return field_->at(T_w_b).penalty.along((T_w_b * field_->mount()).inverse().linear() * t_w);
    };
    const double charge = options_.cost == CostRule::perVertex
                              ? penalty(next.T_w_b)
                              : 0.5 * step * (penalty(last.T_w_b) + penalty(next.T_w_b));
    next.distance += step;
    next.length += way_w.norm();
    next.cost += options_.alpha * step + (1. - options_.alpha) * options_.kappa * charge;
    next.isWaypoint = k == motion.steps;
    return next;
}

void BeliefModel::clear() {
    fallbacks_ = 0;
    seconds_ = 0.;
}

}  // namespace photonav
