// SPDX-License-Identifier: BSD-3-Clause
#include "belief/belief.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "geometry/se3.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

/// Loads a view into the cache while the step before it is compounded: there are tens of thousands
/// of views, anywhere in memory.
void prefetch(const InformationField::Entry& view) {
    constexpr std::size_t kCacheLine = 64;
    const auto* bytes = reinterpret_cast<const char*>(&view);
    for (std::size_t i = 0; i < sizeof(view); i += kCacheLine) __builtin_prefetch(bytes + i);
}

/// Ad of a camera motion in world-oriented axes: [1 t^; 0 1].
/// @param t_w where the camera came from, seen from where it is [m]
Matrix6 translationAdjoint(const Eigen::Vector3d& t_w) {
    Matrix6 Ad = Matrix6::Identity();
    Ad.topRightCorner<3, 3>() = hat(t_w);
    return Ad;
}

/// The update as in textbooks, for evaluate().
Matrix6 updated(const Matrix6& covariance, const Matrix6& information) {
    const Matrix6 after =
        (Matrix6::Identity() + covariance * information).partialPivLu().solve(covariance);
    return 0.5 * (after + after.transpose());
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
    const Pose T_c_b = field_->mount().inverse();
    initialCamera_ = inOtherFrame(options_.initialCovariance, T_c_b);
    noiseCamera_ = inOtherFrame(options_.motionNoise, T_c_b);
}

Belief BeliefModel::root(const ob::State* start) {
    const Pose T_w_b = space_.bodyPose(start);
    Belief belief{inRotatedAxes(initialCamera_, T_w_b.linear() * field_->mount().linear()), 0.};
    if (!options_.viewAtStart || field_->hasPenalties()) return belief;
    const auto& view = field_->at(T_w_b);
    if (!view.isZero) belief.covariance = updateCovariance(belief.covariance, view.information);
    return belief;
}

Matrix6 BeliefModel::informationAt(const Pose& T_w_b) {
    const Eigen::Matrix3d R_c_w = (T_w_b.linear() * field_->mount().linear()).transpose();
    return inRotatedAxes(field_->at(T_w_b).information, R_c_w);
}

Matrix6 BeliefModel::cameraCovariance(const ob::State* state, const Belief& belief) const {
    const Eigen::Matrix3d R_w_c = space_.bodyPose(state).linear() * field_->mount().linear();
    return inRotatedAxes(belief.covariance, R_w_c.transpose());
}

Motion BeliefModel::motion(const ob::State* from, const ob::State* to) const {
    const double length = space_.space()->distance(from, to);
    const bool perVertex = options_.cost == CostRule::perVertex;
    const int steps =
        perVertex ? 1 : std::max(1, static_cast<int>(std::ceil(length / options_.ds - 1e-9)));
    return {from, to, length, steps, {}, 0};
}

std::optional<Belief> BeliefModel::propagateWithin(double limit, const Belief& belief,
                                                   Motion& motion, bool backward) {
    if (field_->hasPenalties()) {
        updateViews(motion);
        return chargePenalties(belief, motion, backward);
    }
    if (motion.views.empty()) {
        motion.views.resize(motion.steps + 1);
        motion.epoch = field_->epoch();
    }
    const auto start = std::chrono::steady_clock::now();
    const double viewSeconds = field_->seconds();
    const auto arrival = propagateNow(limit, belief, motion, backward);
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() -
                (field_->seconds() - viewSeconds);
    return arrival;
}

std::optional<Belief> BeliefModel::propagateNow(double limit, const Belief& belief, Motion& motion,
                                                bool backward) {
    const bool perVertex = options_.cost == CostRule::perVertex;
    const double step = motion.length / motion.steps;
    const double shareOfView = perVertex ? 1. : step / options_.ds;
    const double price = (1. - options_.alpha) * options_.kappa;
    const double begin = belief.cost + options_.alpha * motion.length;
    const double least = leastCharge(motion) / motion.steps;
    const bool turns = space_.kind() != StateKind::position;  // else all steps are alike

    Matrix6 covariance = belief.covariance;
    double charge = 0.;
    double traceAfter = trace(covariance);
    Matrix6 adjointOfStep, noise;
    Pose T_w_c = cameraPose(motion, backward ? motion.steps : 0);
    for (int k = 1; k <= motion.steps; ++k) {
        const int at = backward ? motion.steps - k : k;
        if (motion.views[at] != nullptr) prefetch(*motion.views[at]);
        if (turns || k == 1) {
            const Pose T_w_next = cameraPose(motion, at);
            adjointOfStep = translationAdjoint(T_w_c.translation() - T_w_next.translation());
            noise = inRotatedAxes(step * noiseCamera_, T_w_next.linear());
            T_w_c = T_w_next;
        }
        const auto moved = compoundCovariance(adjointOfStep, noise, covariance, options_.order);
        fallbacks_ += moved.fellBack ? 1 : 0;
        covariance = moved.covariance;
        charge += 0.5 * step * (traceAfter + trace(covariance));  // the trace before the update
        if (!perVertex && begin + price * charge + (motion.steps - k) * least > limit) return {};
        const auto& view = viewAt(motion, at);
        if (!view.isZero) {
            covariance = updateCovariance(covariance, shareOfView * view.information);
        }
        traceAfter = trace(covariance);
    }
    if (perVertex) charge = traceAfter;
    const auto*& unused = motion.views[backward ? motion.steps : 0];
    if (unused != nullptr && unused->isStale) unused = nullptr;
    motion.epoch = field_->epoch();
    return Belief{covariance, charge >= 0. ? begin + price * charge : kInfinity};
}

/// Covers fourth-order terms by 1 %.
double BeliefModel::leastCharge(const Motion& motion) const {
    constexpr double kSafety = 0.99;
    if (options_.cost == CostRule::perVertex || field_->hasPenalties()) return 0.;
    return kSafety * (1. - options_.alpha) * options_.kappa * 0.5 * noiseTrace() * motion.length *
           motion.length / motion.steps;
}

/// The penalty of the views in place of the trace: a motion costs the same for every belief.
Belief BeliefModel::chargePenalties(const Belief& belief, const Motion& motion,
                                    bool backward) const {
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

/// Penalty of flying past the k-th view of a motion, in either direction.
double BeliefModel::penaltyAt(const Motion& motion, int k) const {
    if (motion.length == 0.) return motion.views[k]->penalty.base;  // no motion, no parallax
    const Eigen::Vector3d t_w =
        (space_.position(motion.to) - space_.position(motion.from)) / motion.length;
    return motion.views[k]->penalty.along(t_w);
}

/// Finds all views of a motion, or updates those that became stale by a change of the map.
void BeliefModel::updateViews(Motion& motion) {
    motion.views.resize(motion.steps + 1);
    for (int k = 0; k <= motion.steps; ++k) viewAt(motion, k);
    motion.epoch = field_->epoch();
}

/// The k-th view of a motion, as the map is now.
const InformationField::Entry& BeliefModel::viewAt(Motion& motion, int k) {
    const auto*& view = motion.views[k];
    if (view == nullptr) {
        view = &field_->at(
            space_.poseBetween(motion.from, motion.to, static_cast<double>(k) / motion.steps));
    } else if (motion.epoch != field_->epoch()) {
        field_->current(*view);
    }
    return *view;
}

Pose BeliefModel::cameraPose(const Motion& motion, int k) const {
    return space_.poseBetween(motion.from, motion.to, static_cast<double>(k) / motion.steps) *
           field_->mount();
}

std::vector<BeliefPoint> BeliefModel::evaluate(const std::vector<const ob::State*>& path,
                                               const std::optional<Belief>& root) {
    std::vector<BeliefPoint> points;
    if (path.empty()) return points;
    BeliefPoint start{.T_w_b = space_.bodyPose(path.front()),
                      .covariance = initialCamera_,
                      .traceBefore = trace(initialCamera_),
                      .isWaypoint = true};
    start.information = informationAt(start.T_w_b);
    if (root) {
        start.covariance = cameraCovariance(path.front(), *root);
        start.traceBefore = trace(start.covariance);
        start.cost = root->cost;
    } else if (options_.viewAtStart) {
        start.covariance = updated(initialCamera_, start.information);
    }
    start.trace = trace(start.covariance);
    points.push_back(start);
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
        next.information = informationAt(next.T_w_b);
        next.covariance =
            updated(next.covariance, (perVertex ? 1. : step / options_.ds) * next.information);
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
        return field_->at(T_w_b).penalty.along(t_w);
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
