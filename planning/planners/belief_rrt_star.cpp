// SPDX-License-Identifier: BSD-3-Clause
#include "planners/belief_rrt_star.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/constants.hpp"
#include "geometry/loewner_order.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr double kSearchGrowth = 2.;               // of the roadmap between searches
constexpr double kSearchGrowthWithoutPath = 1.25;  // while no search has reached the goal
constexpr double kSearchMargin = 1.5;              // a search takes so much longer than expected

constexpr double kWellObserved =
    1.5;  // times the base cost: a path that costs less is well observed

constexpr double kLittle = 0.02;            // of the cost: not worth another path
constexpr double kCaution = 1.06;           // factor on the gain after a descent in vain,
constexpr double kForgetting = 0.995;       // and after an update without one
constexpr double kChangesOfUpdate = 0.01;   // share of the descent from the first plan
constexpr double kFirstStepOfUpdate = 0.5;  // of that descent [m, rad]

constexpr double kDominanceSlack = 0.02;  // see isDominated()
constexpr double kMinLever = 1.;          // [m]
constexpr double kMaxLever = 100.;        // [m]

}  // namespace

BeliefRRTstar::BeliefRRTstar(const ob::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                             const SearchOptions& search, const GrowthOptions& growth)
    : BeliefPlanner(si, std::move(model), "belief_rrt_star", growth), options_(search) {
    declareOption("labels", options_.labels);
    declareOption("informed", options_.informed);
    declareOption("shortcut", options_.shortcut);
    declareOption("commitment", options_.commitment);
    declareOption("inflation", options_.inflation);
    addPlannerProgressProperty("shortcuts tried INTEGER",
                               [this] { return std::to_string(shortcutsTried_); });
    addPlannerProgressProperty("shortcuts taken INTEGER",
                               [this] { return std::to_string(shortcutsTaken_); });
}

/// A roadmap that has changed is searched before it grows, unless there is a path still. So is one
/// whose last search was stopped: without a descent its path would seldom be an improvement.
void BeliefRRTstar::begin(const ob::PlannerTerminationCondition& ptc) {
    keptCost_ = isFollowing_ ? bestCost() : kInfinity;
    kept_.reset();
    if (isFollowing_ && hasReferenceModel()) {
        kept_.emplace(si_);
        for (const ob::State* state : bestPath()) kept_->append(state);
    }
    if (!isSearchDue_ || isFollowing_ || goals_.empty()) return;
    search(ptc);
    if (isSearchDue_) return;  // it was stopped
    descend(ptc, std::min(options_.shortcut, static_cast<unsigned>(vertices())));
}

void BeliefRRTstar::connect(Vertex& fresh, const std::vector<Vertex*>& near,
                            const ob::PlannerTerminationCondition& ptc) {
    for (Vertex* vertex : near) {
        roadmap_.add(vertex, &fresh, model_->motion(vertex->state, fresh.state));
    }
    roadmap_.of(&fresh).front()->isFree = true;
    if (fresh.index < promising_.size()) promising_[fresh.index] = true;
    isSearchDue_ = true;
    if (fresh.isGoal && bestCost() == kInfinity) offerCheckedPath(fresh, ptc);
    const double growth = path_.empty() ? kSearchGrowthWithoutPath : kSearchGrowth;
    const std::size_t first = hasDeadline() ? kFirstSearchWithDeadline : kFirstSearch;
    const double due = std::max<double>(first, growth * static_cast<double>(searched_));
    if (goals_.empty() || static_cast<double>(vertices()) < due) return;
    search(ptc);
    if (isSearchDue_) return;  // it was stopped
    promising_.assign(vertices_.size(), false);
    for (const Label& label : settled_) promising_[label.vertex->index] = true;
    descend(ptc, static_cast<unsigned>(vertices()));
}

/// Stores a path to a goal over edges that are already checked, as a solution until the first
/// search.
void BeliefRRTstar::offerCheckedPath(const Vertex& goal,
                                     const ob::PlannerTerminationCondition& ptc) {
    std::vector<Roadmap::Edge*> arrival(vertices_.size(), nullptr);
    std::vector<const Vertex*> reached{&goal};  // backward from the goal, breadth first
    const auto rootAt = [&](const Vertex* vertex) {
        return std::find_if(roots_.begin(), roots_.end(),
                            [&](const Root& root) { return root.vertex == vertex; });
    };
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const Vertex* vertex = reached[i];
        if (const auto root = rootAt(vertex); root != roots_.end()) {
            std::vector<const ob::State*> path{vertex->state};
            Belief belief = root->belief;
            while (vertex != &goal) {
                if (ptc) return;
                Roadmap::Edge& edge = *arrival[vertex->index];
                belief = propagate(belief, edge.motion, vertex == edge.to);
                vertex = edge.otherEnd(vertex);
                path.push_back(vertex->state);
            }
            offer(belief.cost, path);
            return;
        }
        for (Roadmap::Edge* edge : roadmap_.of(vertex)) {
            const Vertex* next = edge->otherEnd(vertex);
            if (!edge->isFree.value_or(false) || next == &goal) continue;
            if (arrival[next->index] != nullptr) continue;
            arrival[next->index] = edge;
            reached.push_back(next);
        }
    }
}

/// Whether the last search reached the vertex by a path that could still have been the best, or the
/// vertex is newer.
bool BeliefRRTstar::isPromising(const Vertex& nearest) {
    return !options_.informed || nearest.index >= promising_.size() || promising_[nearest.index];
}

void BeliefRRTstar::finish(const ob::PlannerTerminationCondition& ptc) {
    if (isSearchDue_) search(ptc);
    if (isFollowing_) {
        follow(ptc);
        return;
    }
    descend(ptc, options_.shortcut);
    if (descent_) gain_ = descent_->cost() / pathCost_;
}

/// After an update that kept a path: works a little on that path or, if the search has found one of
/// the roadmap that promises more, on that one.
void BeliefRRTstar::follow(const ob::PlannerTerminationCondition& ptc) {
    if (!path_.empty()) {
        const double kept = bestCost();
        descend(ptc, options_.shortcut);
        compareWithKept(ptc);
        const bool wasInVain = bestCost() >= kept;
        gain_ = bestCost() / pathCost_ * (wasInVain ? kCaution : 1.);
    } else if (options_.shortcut > 0) {
        PathDescent descent = descentAt({bestPath().begin(), bestPath().end()}, kFirstStepOfUpdate);
        descend(descent, ptc, static_cast<unsigned>(kChangesOfUpdate * options_.shortcut));
        offer(descent.cost(), descent.path());
        gain_ *= kForgetting;
    }
    if (ptc) return;
    isFollowing_ = false;
    limitOfUpdate_ = kInfinity;
}

/// Returns to the path that an update has kept, unless the reference model as well finds the other
/// one better.
void BeliefRRTstar::compareWithKept(const ob::PlannerTerminationCondition& ptc) {
    if (!kept_ || bestCost() == keptCost_) return;
    auto& kept = kept_->getStates();
    const auto before = referenceCost(kept, ptc);
    const auto other = referenceCost(bestPath(), ptc);
    if (before && other && *other <= (1. - options_.commitment) * *before) return;
    replaceBest(keptCost_, {kept.begin(), kept.end()});
}

/// The path that an update has kept comes from a descent, which lowers the cost of a path over the
/// roadmap by a factor, the gain of the last descent. A path over the roadmap is of interest if
/// a descent from it may end with a cost that is lower by more than a small share.
double BeliefRRTstar::limitOfUpdate() const {
    if (!isFollowing_) return kInfinity;
    const bool hasDescents = options_.shortcut > 0;
    const double worthIt = std::max(hasDescents ? kLittle : 0., options_.commitment);
    return (1. - worthIt) / (hasDescents ? gain_ : 1.) * bestCost();
}

/// Estimated from the durations of the last search and of the changes so far. Before the first
/// search all of the time that finish() may take.
double BeliefRRTstar::timeToFinish() const {
    if (goals_.empty()) return 0.;
    if (searched_ == 0) return kInfinity;
    const double growth = static_cast<double>(vertices()) / static_cast<double>(searched_);
    const double descent = shortcutsTried_ > 0
                               ? descentSeconds_ / shortcutsTried_ * options_.shortcut
                               : searchSeconds_;
    return kSearchMargin * growth * searchSeconds_ + descent;
}

/// Best-first search over labels (vertex, belief). No path through a label costs less than the
/// label's bound, so the first label that is settled at a goal is the best one, given the labels
/// kept.
void BeliefRRTstar::search(const ob::PlannerTerminationCondition& ptc) {
    if (ptc) return;
    const double start = now();
    roadmap_.resize(vertices_.size());
    settled_.clear();
    labelsOf_.assign(vertices_.size(), {});
    if (!roadmap_.checkAll(*si_, ptc)) return;
    std::vector<CostToGo::Start> starts;
    for (const Root& root : roots_) starts.push_back({root.vertex, root.belief.covariance});
    if (!toGo_.update(roadmap_, vertices_, goals_, *model_, starts, isWellObserved_, ptc)) return;

    raise_ = isWellObserved_ ? 1. + options_.inflation * (overBase_ - 1.) : 1.;

    Open open;
    for (const Root& root : roots_) {
        Candidate candidate{0., -1, nullptr, root.vertex};
        candidate.belief = std::make_unique<Belief>(root.belief);
        push(open, std::move(candidate));
    }
    while (!open.empty()) {
        if (ptc) return;
        std::pop_heap(open.begin(), open.end());
        Candidate candidate = std::move(open.back());
        open.pop_back();
        if (isFull(*candidate.vertex)) continue;
        if (candidate.belief == nullptr) {
            if (propagateTo(candidate)) push(open, std::move(candidate));
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
    searched_ = vertices();
    isSearchDue_ = false;
    searchSeconds_ = now() - start;
}

void BeliefRRTstar::push(Open& open, Candidate candidate) const {
    if (!(candidate.bound <= limit()) || candidate.bound == kInfinity) return;
    open.push_back(std::move(candidate));
    std::push_heap(open.begin(), open.end());
}

void BeliefRRTstar::expand(int label, Open& open) const {
    const auto& [vertex, parent, belief] = settled_[label];
    const auto variances = toGo_.variances(belief.covariance);
    for (Roadmap::Edge* edge : roadmap_.of(vertex)) {
        Vertex* next = edge->otherEnd(vertex);
        if (isFull(*next) || !*edge->isFree) continue;
        push(open,
             {belief.cost + raise_ * toGo_.over(*edge, *vertex, variances), label, edge, next});
    }
}

/// @return whether the label is neither dominated nor too costly
bool BeliefRRTstar::propagateTo(Candidate& candidate) {
    Roadmap::Edge& edge = *candidate.edge;
    const Vertex& vertex = *candidate.vertex;
    const auto arrival = model_->propagateWithin(limit() - raise_ * toGo_.baseCost(vertex),
                                                 settled_[candidate.parent].belief, edge.motion,
                                                 candidate.vertex == edge.from);
    if (!arrival || isDominated(vertex, *arrival)) return false;
    candidate.bound =
        arrival->cost + raise_ * toGo_.from(vertex, toGo_.variances(arrival->covariance));
    candidate.belief = std::make_unique<Belief>(*arrival);
    return candidate.bound <= limit();
}

/// A belief is dominated by a settled label that costs no more, if no direction of its covariance
/// is smaller by more than the slack, relative to the variance in this direction and to the trace.
/// Without the slack relative to the trace, labels with a negligible advantage in roll would be
/// kept, and displace labels that matter. A rotation error is weighted by the position error that
/// it causes on the way to the goal.
bool BeliefRRTstar::isDominated(const Vertex& vertex, const Belief& belief) const {
    const double lever = std::clamp(toGo_.distance(vertex), kMinLever, kMaxLever);
    Matrix6 limit = (1. + kDominanceSlack) * belief.covariance;
    const double whole = kDominanceSlack * weightedTrace(belief.covariance, lever);
    limit.diagonal().head<3>().array() += whole;
    limit.diagonal().tail<3>().array() += whole / (lever * lever);
    for (const int label : labelsOf_[vertex.index]) {
        const Belief& known = settled_[label].belief;
        if (known.cost > belief.cost) continue;
        if (isLoewnerLess(known.covariance, limit)) return true;
    }
    return false;
}

void BeliefRRTstar::keepPath(int label) {
    pathCost_ = settled_[label].belief.cost;
    const Label& start = settled_.front();
    overBase_ = (pathCost_ - start.belief.cost) / toGo_.baseCost(*start.vertex);
    isWellObserved_ = overBase_ < kWellObserved;
    std::vector<const ob::State*> path;
    for (; label >= 0; label = settled_[label].parent) {
        path.push_back(settled_[label].vertex->state);
    }
    std::reverse(path.begin(), path.end());
    if (path == path_) return;
    path_ = std::move(path);
    descent_.reset();
    offerAnother(pathCost_, path_);
}

/// A path that does not come from the one that an update has kept.
void BeliefRRTstar::offerAnother(double cost, const std::vector<const ob::State*>& path) {
    if (isFollowing_ && cost > (1. - options_.commitment) * keptCost_) return;
    offer(cost, path);
}

/// Descends from the best path of the roadmap until this number of changes was tried, in all calls
/// together.
void BeliefRRTstar::descend(const ob::PlannerTerminationCondition& ptc, unsigned changes) {
    if (options_.shortcut == 0 || path_.empty()) return;
    if (!descent_) descent_ = descentAt(path_, DescentOptions{}.firstStep);
    descend(*descent_, ptc, changes);
    offerAnother(descent_->cost(), descent_->path());
}

PathDescent BeliefRRTstar::descentAt(const std::vector<const ob::State*>& path,
                                     double firstStep) const {
    PathDescent descent(si_, model_, {.moves = options_.shortcut, .firstStep = firstStep});
    const auto root = std::find_if(roots_.begin(), roots_.end(), [&](const Root& r) {
        return si_->equalStates(r.vertex->state, path.front());
    });
    descent.begin(path, root->belief);
    return descent;
}

void BeliefRRTstar::descend(PathDescent& descent, const ob::PlannerTerminationCondition& ptc,
                            unsigned changes) {
    const double start = now();
    const unsigned tried = descent.tried();
    const unsigned accepted = descent.accepted();
    descent.descend(ptc, changes);
    shortcutsTried_ += descent.tried() - tried;
    shortcutsTaken_ += descent.accepted() - accepted;
    descentSeconds_ += now() - start;
}

BeliefPlanner::Invalid BeliefRRTstar::invalidate(const ChangedSpace& changed,
                                                 std::vector<Vertex*> colliding) {
    return {std::move(colliding), roadmap_.mapChanged(changed, model_->space(), *si_)};
}

/// Of the labels of the last search. The first label that a vertex keeps is its cheapest one as far
/// as the goal is concerned: it settled first.
std::vector<const Vertex*> BeliefRRTstar::parents() const {
    std::vector<const Vertex*> parents(vertices_.size(), nullptr);
    for (std::size_t i = 0; i < labelsOf_.size(); ++i) {
        if (labelsOf_[i].empty()) continue;
        const int parent = settled_[labelsOf_[i].front()].parent;
        if (parent >= 0) parents[i] = settled_[parent].vertex;
    }
    return parents;
}

/// The result of the last search belongs to another map: the next solve() searches again.
void BeliefRRTstar::renewBeliefs() {
    settled_.clear();
    labelsOf_.clear();
    promising_.clear();
    path_.clear();
    pathCost_ = kInfinity;
    descent_.reset();
    isFollowing_ = bestCost() < kInfinity;
    limitOfUpdate_ = limitOfUpdate();
    searched_ = isFollowing_ ? vertices() : 0;
    isSearchDue_ = true;
}

std::vector<Vertex*> BeliefRRTstar::replaceRoots(const Root& root,
                                                 const std::vector<Vertex*>& near) {
    for (Vertex* vertex : near) {
        roadmap_.add(root.vertex, vertex, model_->motion(root.vertex->state, vertex->state));
    }
    renewBeliefs();
    return {};
}

void BeliefRRTstar::clear() {
    BeliefPlanner::clear();
    roadmap_.clear();
    renewBeliefs();
    isSearchDue_ = false;
    gain_ = 1.;
    isWellObserved_ = true;
    overBase_ = raise_ = 1.;
    searchSeconds_ = descentSeconds_ = 0.;
    shortcutsTried_ = shortcutsTaken_ = 0;
}

std::vector<TreeNode> BeliefRRTstar::tree() const {
    std::vector<TreeNode> nodes;
    nodes.reserve(settled_.size());
    for (const Label& label : settled_) {
        const ob::State* state = label.vertex->state;
        nodes.push_back({state, label.parent, label.belief.cost,
                         model_->cameraCovariance(state, label.belief)});
    }
    return nodes;
}

}  // namespace photonav
