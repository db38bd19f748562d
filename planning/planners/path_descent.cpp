// SPDX-License-Identifier: BSD-3-Clause
#include "planners/path_descent.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/loewner_order.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr double kRefinement = 0.6;    // of the shifts from round to round
constexpr double kShortestLeg = 0.25;  // a leg shorter than twice this is not bent [m]
constexpr double kMinGain = 1e-9;      // relative: what counts as lower cost

/// Whether `covariance` is in no direction smaller than `known`, except for rounding. If the cost
/// is not lower either, the whole path costs no less, since the cost-to-go grows with the
/// covariance.
bool isNowhereBetter(const Matrix6& covariance, const Matrix6& known) {
    Matrix6 limit = covariance;
    limit.diagonal() += 1e-9 * known.diagonal();
    return isLoewnerLess(known, limit);
}

}  // namespace

PathDescent::PathDescent(ob::SpaceInformationPtr si, std::shared_ptr<BeliefModel> model,
                         const DescentOptions& options)
    : si_(std::move(si)), model_(std::move(model)), options_(options) {}

void PathDescent::begin(const std::vector<const ob::State*>& path) {
    begin(path, model_->root(path.front()));
}

void PathDescent::begin(const std::vector<const ob::State*>& path, const Belief& root) {
    sampler_ = model_->space().sampler(options_.seed);
    tried_ = accepted_ = 0;
    step_ = options_.firstStep;
    nodes_.clear();
    for (const ob::State* state : path) {
        Node& node = nodes_.emplace_back();
        node.state = between(state, state, 0.);
        if (nodes_.size() == 1) {
            node.belief = root;
            continue;
        }
        const Node& last = nodes_[nodes_.size() - 2];
        node.arrival = model_->motion(last.state.get(), node.state.get());
        node.belief = model_->propagate(last.belief, node.arrival);
    }
}

/// Repeats rounds from coarse to fine shifts: a large shift that failed may help in another
/// direction, or after fine shifts. Ends before the moves are used up only if the path is too short
/// to be changed.
void PathDescent::descend(const ob::PlannerTerminationCondition& ptc, unsigned moves) {
    ptc_ = &ptc;
    lastMove_ = std::min(options_.moves, moves);
    removeVertices();
    unsigned begun = 0;
    do {
        begun = tried_;
        for (; step_ >= options_.lastStep && !isOver(); step_ *= kRefinement) {
            shiftVertices(step_);
            shiftLegs(step_);
            bendLegs(step_);
            cutCorners();
            removeVertices();
        }
        if (step_ < options_.lastStep) step_ = options_.firstStep;
    } while (!isOver() && tried_ > begun);
    ptc_ = nullptr;
}

void PathDescent::removeVertices() {
    for (std::size_t i = 1; i + 1 < nodes_.size() && !isOver();) {
        if (!tryReplace(i - 1, i + 1, {})) ++i;
    }
}

void PathDescent::shiftVertices(double step) {
    for (std::size_t i = 1; i + 1 < nodes_.size() && !isOver(); ++i) {
        tryBothWays(i - 1, i + 1, nodes_[i].state, nullptr, step);
    }
}

/// Both ends of an inner leg by the same shift.
void PathDescent::shiftLegs(double step) {
    for (std::size_t i = 1; i + 2 < nodes_.size() && !isOver(); ++i) {
        tryBothWays(i - 1, i + 2, nodes_[i].state, nodes_[i + 1].state, step);
    }
}

void PathDescent::bendLegs(double step) {
    for (std::size_t i = 1; i < nodes_.size() && !isOver(); ++i) {
        const double length = nodes_[i].arrival.length;
        if (length < 2. * kShortestLeg) continue;
        const StatePtr middle = between(nodes_[i - 1].state.get(), nodes_[i].state.get(), 0.5);
        if (tryBothWays(i - 1, i, middle, nullptr, std::min(step, 0.5 * length))) ++i;
    }
}

void PathDescent::cutCorners() {
    for (std::size_t i = 1; i + 1 < nodes_.size() && !isOver(); ++i) {
        const ob::State* corner = nodes_[i].state.get();
        const double before = nodes_[i].arrival.length;
        const double after = nodes_[i + 1].arrival.length;
        const double cut = std::min(before, after) / 3.;
        if (cut < kShortestLeg) continue;
        tryReplace(i - 1, i + 1,
                   {between(corner, nodes_[i - 1].state.get(), cut / before),
                    between(corner, nodes_[i + 1].state.get(), cut / after)});
    }
}

/// Shifts a state by at most `step` in a random direction, or else in the opposite one, and repeats
/// the shift while the cost falls. `follower`, if any, is shifted alike. Both are copied, since a
/// replacement frees the nodes that they come from.
bool PathDescent::tryBothWays(std::size_t first, std::size_t last, StatePtr centre,
                              StatePtr follower, double step) {
    const bool isLeg = follower != nullptr;
    const StatePtr away = between(centre.get(), centre.get(), 0.);
    sampler_->sampleUniformNear(away.get(), centre.get(), step);
    const auto tryShift = [&, centre = std::move(centre),
                           follower = std::move(follower)](double t) {
        std::vector<StatePtr> states{between(centre.get(), away.get(), t)};
        if (isLeg) states.push_back(parallel(*centre, *states[0], *follower));
        return tryReplace(first, last, states);
    };
    double t = 1.;
    if (!tryShift(t)) {
        t = -1.;
        if (!tryShift(t)) return false;
    }
    last = first + (isLeg ? 3 : 2);  // one state more where a leg was bent
    do {
        t *= 2.;
    } while (!isOver() && tryShift(t));
    return true;
}

/// Replaces what lies between the nodes `first` and `last` by other states, if that costs less.
bool PathDescent::tryReplace(std::size_t first, std::size_t last,
                             const std::vector<StatePtr>& between) {
    ++tried_;
    const double limit = cost() * (1. - kMinGain);
    std::vector<Node> fresh;
    double rest = leastRest(last);
    const auto addMotion = [&](const ob::State* from, const StatePtr& to) {
        fresh.push_back({to, model_->motion(from, to.get()), {}});
        rest += model_->lowerBound(fresh.back().arrival);
    };
    for (const StatePtr& state : between) {
        addMotion(fresh.empty() ? nodes_[first].state.get() : fresh.back().state.get(), state);
    }
    addMotion(fresh.empty() ? nodes_[first].state.get() : fresh.back().state.get(),
              nodes_[last].state);

    Belief belief = nodes_[first].belief;
    for (Node& node : fresh) {
        if (belief.cost + rest >= limit) return false;
        if (node.arrival.length == 0.) return false;
        if (!si_->checkMotion(node.arrival.from, node.arrival.to)) return false;
        rest -= model_->lowerBound(node.arrival);
        const auto arrival = model_->propagateWithin(limit - rest, belief, node.arrival);
        if (!arrival) return false;
        belief = node.belief = *arrival;
    }
    std::vector<Belief> beliefs;
    if (!propagateRest(last, belief, beliefs)) return false;

    ++accepted_;
    for (std::size_t i = 0; i < beliefs.size(); ++i) nodes_[last + 1 + i].belief = beliefs[i];
    const auto begin = nodes_.begin() + static_cast<std::ptrdiff_t>(first) + 1;
    const auto end = nodes_.begin() + static_cast<std::ptrdiff_t>(last) + 1;
    nodes_.insert(nodes_.erase(begin, end), std::make_move_iterator(fresh.begin()),
                  std::make_move_iterator(fresh.end()));
    for (std::size_t i = 0; i <= first; ++i) nodes_[i].leastRest.reset();
    return true;
}

/// Least cost of the path after a node: the cost if the covariance at the node is zero. The cost
/// of the rest grows with the covariance, and the views are those of the path as it is.
double PathDescent::leastRest(std::size_t i) {
    auto& least = nodes_[i].leastRest;
    if (!least) {
        Belief exact;
        for (std::size_t k = i + 1; k < nodes_.size(); ++k) {
            exact = model_->propagate(exact, nodes_[k].arrival);
        }
        least = exact.cost;
    }
    return *least;
}

/// The beliefs after node `last`, if it is reached with this belief. Stops as soon as the path
/// cannot become cheaper.
bool PathDescent::propagateRest(std::size_t last, Belief belief, std::vector<Belief>& beliefs) {
    const double limit = cost() * (1. - kMinGain);
    for (std::size_t i = last;; ++i) {
        if (belief.cost + leastRest(i) >= limit) return false;
        if (i + 1 == nodes_.size()) return true;
        if (belief.cost >= nodes_[i].belief.cost &&
            isNowhereBetter(belief.covariance, nodes_[i].belief.covariance)) {
            return false;
        }
        belief = model_->propagate(belief, nodes_[i + 1].arrival);
        beliefs.push_back(belief);
    }
}

/// The fourth corner of a parallelogram: `follower` moved as `from` moved to `to`.
PathDescent::StatePtr PathDescent::parallel(const ob::State& from, const ob::State& to,
                                            const ob::State& follower) const {
    return between(&from, between(&to, &follower, 0.5).get(), 2.);
}

PathDescent::StatePtr PathDescent::between(const ob::State* from, const ob::State* to,
                                           double t) const {
    StatePtr state(si_->cloneState(from), [si = si_](ob::State* s) { si->freeState(s); });
    if (t != 0.) {
        si_->getStateSpace()->interpolate(from, to, t, state.get());
        si_->enforceBounds(state.get());
    }
    return state;
}

std::vector<const ob::State*> PathDescent::path() const {
    std::vector<const ob::State*> states;
    for (const Node& node : nodes_) states.push_back(node.state.get());
    return states;
}

}  // namespace photonav
