// SPDX-License-Identifier: BSD-3-Clause
// How a planner is updated when the map or the position of the robot changes.
#include <algorithm>

#include "geometry/segment.hpp"
#include "planners/belief_planner.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

/// Extra cost of a detour, as a share of the blocked path's cost: larger ones, and no detour at
/// all, count as this.
constexpr double kMostDetour = 2.;

}  // namespace

void BeliefPlanner::mapChanged(const MapChange& change) {
    // Entries of the field may become stale without a change, see updatesUntilStale.
    const bool isFieldUpdated = fieldEpoch_ != model_->field().epoch();
    if ((change.empty() && !isFieldUpdated) || roots_.empty()) return;
    fieldEpoch_ = model_->field().epoch();
    beginUpdate();
    iterationsAtChange_ = iterations_;
    updated_.addChange(change);
    removeColliding(ChangedSpace(change, growth_.obstacleReach));
    clearIfInterrupted([&] {
        if (!movedRoot_) {  // the views from the starts may have changed
            for (Root& root : roots_) root.belief = rootBelief(root.vertex->state);
        }
        reevaluateBest();
        renewBeliefs();
    });
    reportUpdate();
}

void BeliefPlanner::reportUpdate() {
    pdef_->clearSolutionPaths();
    if (!best_.states.empty()) addSolution();
    publishProgress();
}

/// An update that ends by an exception, for example because rendering was stopped, would leave
/// beliefs of two maps in one tree: planning begins anew from the present root.
void BeliefPlanner::clearIfInterrupted(const std::function<void()>& update) {
    try {
        update();
    } catch (...) {
        const std::optional<Belief> belief = movedRoot_;
        clear();
        pdef_->clearSolutionPaths();
        if (belief) {
            ob::ScopedState<> root(si_);
            root = pdef_->getStartState(0);
            moveRoot(root.get(), *belief);
        }
        throw;
    }
}

/// Roots are kept even in collision: the robot is there, although it has no path.
void BeliefPlanner::removeColliding(const ChangedSpace& changed) {
    std::vector<Vertex*> colliding;
    for (Vertex& vertex : vertices_) {
        if (vertex.state == nullptr || isRoot(vertex)) continue;
        if (!changed.contains(model_->space().position(vertex.state))) continue;
        if (!si_->isValid(vertex.state)) colliding.push_back(&vertex);
    }
    const Invalid invalid = invalidate(changed, std::move(colliding));
    update_.edgesInvalidated += invalid.edges;
    remove(invalid.vertices);
}

/// The first change after a solve() begins an update, those that follow belong to it.
void BeliefPlanner::beginUpdate() {
    if (!isSolved_) return;
    isSolved_ = false;
    if (update_.verticesAdded >= verticesToAdd()) updated_.clear();
    update_ = {};
    forBlockedNow_ = 0;
    parentsBefore_ = parents();
}

/// In the parts of the space that the present update has affected.
std::size_t BeliefPlanner::verticesToAdd() const {
    return update_.verticesInvalidated + forBlockedNow_;
}

/// Removed vertices are used again for other states: neither they nor their children keep the
/// parent that they had before the update.
void BeliefPlanner::forgetParents(const std::vector<Vertex*>& removed) {
    static const Vertex kRemoved;
    if (parentsBefore_.empty() || removed.empty()) return;
    std::vector<bool> isRemoved(vertices_.size(), false);
    for (const Vertex* vertex : removed) isRemoved[vertex->index] = true;
    for (std::size_t i = 0; i < parentsBefore_.size(); ++i) {
        const Vertex*& parent = parentsBefore_[i];
        if (isRemoved[i]) parent = nullptr;
        if (parent == nullptr || parent == &kRemoved) continue;
        if (isRemoved[parent->index]) parent = &kRemoved;
    }
}

void BeliefPlanner::countRewired() {
    isSolved_ = true;
    update_.verticesRewired = 0;
    if (parentsBefore_.empty()) return;
    const auto now = parents();
    for (std::size_t i = 0; i < parentsBefore_.size(); ++i) {
        const bool isCompared = parentsBefore_[i] != nullptr && now[i] != nullptr;
        update_.verticesRewired += isCompared && now[i] != parentsBefore_[i] ? 1 : 0;
    }
}

bool BeliefPlanner::isRoot(const Vertex& vertex) const {
    return std::any_of(roots_.begin(), roots_.end(),
                       [&](const Root& root) { return root.vertex == &vertex; });
}

void BeliefPlanner::moveRoot(const ob::State* given, const Belief& belief) {
    checkValidity();
    beginUpdate();
    iterationsAtChange_ = iterations_;
    ob::ScopedState<> copy(si_);  // the given one may be the problem's
    copy = given;
    const ob::State* const state = copy.get();
    pdef_->clearStartStates();
    pdef_->addStartState(state);
    Vertex probe;
    probe.state = const_cast<ob::State*>(state);
    Vertex* root = neighbours_->size() > 0 ? neighbours_->nearest(&probe) : nullptr;
    std::vector<Vertex*> others;
    if (root == nullptr || si_->distance(root->state, state) > 0.) {
        if (root != nullptr) others = near(probe, root);
        root = &addVertex(state);
        neighbours_->add(root);
        movedRoots_.push_back(root);
    }
    root->isGoal = pdef_->getGoal()->isSatisfied(state);
    if (root->isGoal && std::find(goals_.begin(), goals_.end(), root) == goals_.end()) {
        goals_.push_back(root);
    }
    roots_ = {{root, belief}};
    movedRoot_ = belief;
    if (best_.states.empty()) std::swap(best_.states, blocked_);
    joinRootToBest();
    clearIfInterrupted([&] {
        reevaluateBest();
        remove(replaceRoots(roots_.front(), others));
        removeFormerRoots();
    });
    if (root->isGoal) offer(belief.cost, {root->state});
    reportUpdate();
}

/// A robot that hovers would fill the graph with them.
void BeliefPlanner::removeFormerRoots() {
    const std::vector<Vertex*> former = movedRoots_;
    for (Vertex* vertex : former) {
        if (!isRoot(*vertex) && !isNeeded(*vertex)) erase({vertex});
    }
}

/// Replaces the part of the best path before the leg nearest to the root.
void BeliefPlanner::joinRootToBest() {
    auto& states = best_.states;
    if (states.size() < 2) return;
    const FlightSpace& space = model_->space();
    const ob::State* root = roots_.front().vertex->state;
    const Eigen::Vector3d here = space.position(root);
    const auto at = [&](std::size_t i) { return space.position(states[i]); };
    constexpr double kSame = 1e-9;  // [m]
    std::size_t next = 1;
    double least = kInfinity;
    for (std::size_t i = 1; i < states.size(); ++i) {
        const double distance = distanceToSegment(here, at(i - 1), at(i));
        // Of two legs that meet at the root, the second; but not a way back along the way out.
        const bool isAtNextLeg = i == next + 1 && distance <= least + kSame &&
                                 (here - at(i - 1)).norm() <= distance + kSame;
        if (distance >= least - kSame && !isAtNextLeg) continue;
        least = distance;
        next = i;
    }
    if (si_->distance(root, states[next]) > 0. && !si_->checkMotion(root, states[next])) --next;
    if (next + 1 < states.size() && si_->distance(root, states[next]) == 0.) ++next;
    for (std::size_t i = 0; i < next; ++i) si_->freeState(states[i]);
    states.erase(states.begin(), states.begin() + static_cast<std::ptrdiff_t>(next));
    states.insert(states.begin(), si_->cloneState(root));
}

/// Sets the best path aside unless it is free from a root on, else computes its present cost.
void BeliefPlanner::reevaluateBest() {
    if (best_.states.empty()) return;
    if (const auto cost = costOf(best_.states)) {
        best_.cost = *cost;
        return;
    }
    dropBlocked();
    blocked_ = std::move(best_.states);
    if (best_.cost < kInfinity) blockedCost_ = best_.cost;
    best_ = {kInfinity, {}};
}

/// The next samples are drawn around the motions of the best path that a change has blocked, the
/// more of them the costlier the detour is over what is left of the graph.
void BeliefPlanner::growAroundBlocked() {
    const double ratio = bestCost() / blockedCost_;
    const double detour = ratio > 1. ? std::min(ratio - 1., kMostDetour) : 0.;
    const auto more =
        static_cast<std::size_t>(growthPerDetour() * detour * static_cast<double>(samples()));
    const bool isRoom = forBlocked_ + more <= growth_.maxVertices;
    if (more > 0 && isRoom && addBlocked()) {
        forBlocked_ += more;
        forBlockedNow_ = more;
    }
    dropBlocked();
}

/// @return whether a motion of the path is blocked
bool BeliefPlanner::addBlocked() {
    bool isAny = false;
    ob::ScopedState<> between(si_);
    for (std::size_t i = 1; i < blocked_.size(); ++i) {
        const ob::State *from = blocked_[i - 1], *to = blocked_[i];
        if (si_->checkMotion(from, to)) continue;
        isAny = true;
        const int steps = 1 + static_cast<int>(si_->distance(from, to) / connectionRadius());
        for (int k = 0; k <= steps; ++k) {
            const double share = static_cast<double>(k) / steps;
            si_->getStateSpace()->interpolate(from, to, share, between.get());
            updated_.addRemoved(between.get());
        }
    }
    return isAny;
}

void BeliefPlanner::dropBlocked() {
    si_->freeStates(blocked_);
    blocked_.clear();
}

std::optional<double> BeliefPlanner::costOf(const std::vector<ob::State*>& path) {
    const Root* root = rootAt(path.front());
    if (root == nullptr || !si_->isValid(path.front())) return {};
    for (std::size_t i = 1; i < path.size(); ++i) {
        if (!si_->checkMotion(path[i - 1], path[i])) return {};
    }
    Belief belief = root->belief;
    for (std::size_t i = 1; i < path.size(); ++i) {
        Motion motion = model_->motion(path[i - 1], path[i]);
        belief = propagate(belief, motion, false);
    }
    return belief.cost;
}

std::optional<double> BeliefPlanner::referenceCost(const std::vector<ob::State*>& path,
                                                   const ob::PlannerTerminationCondition& ptc) {
    BeliefModel& reference = reference_ ? *reference_ : *model_;
    Belief belief = rootAt(path.front())->belief;
    for (std::size_t i = 1; i < path.size(); ++i) {
        if (ptc) return {};
        Motion motion = reference.motion(path[i - 1], path[i]);
        belief = reference.propagate(belief, motion);
    }
    return belief.cost;
}

const BeliefPlanner::Root* BeliefPlanner::rootAt(const ob::State* state) const {
    const auto root = std::find_if(roots_.begin(), roots_.end(), [&](const Root& r) {
        return si_->equalStates(r.vertex->state, state);
    });
    return root == roots_.end() ? nullptr : &*root;
}

}  // namespace photonav
