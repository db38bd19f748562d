// SPDX-License-Identifier: BSD-3-Clause
#include "planners/belief_planner.hpp"

#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/datastructures/NearestNeighborsGNATNoThreadSafety.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>

#include "geometry/constants.hpp"
#include "io/interrupted.hpp"
#include "io/stopwatch.hpp"
#include "planners/ompl_objective.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr double kExploration = 0.2;     // share of the samples that are accepted anywhere
constexpr int kMostFailures = 500;       // in a row: the updated space cannot be reached
constexpr double kMaxFinishShare = 0.5;  // largest share of the time limit for finish()
constexpr int kGoalReserve = 20;         // vertices beyond the largest number, to reach a goal
constexpr double kAnotherRound = 2.;     // times as long as finish() took must be left to grow on

/// OMPL's nearest-neighbour tree seeds its choice of pivots by the clock, and the order of vertices
/// at the same distance depends on the pivots. Here the seed is always the same.
template <typename T>
class SeededNeighbours : public ompl::NearestNeighborsGNATNoThreadSafety<T> {
  public:
    SeededNeighbours() { Pivots::rngOf(this->pivotSelector_).setLocalSeed(1); }

  private:
    struct Pivots : ompl::GreedyKCenters<T> {
        static ompl::RNG& rngOf(ompl::GreedyKCenters<T>& centers) {
            return centers.*(&Pivots::rng_);
        }
    };
};

}  // namespace

BeliefPlanner::BeliefPlanner(const ob::SpaceInformationPtr& si, std::shared_ptr<BeliefModel> model,
                             const std::string& name, const GrowthOptions& growth)
    : ob::Planner(si, name),
      model_(std::move(model)),
      growth_(growth),
      clock_([watch = Stopwatch()] { return watch.seconds(); }),
      best_{kInfinity, {}},
      updated_(si, model_->space()),
      objective_(std::make_shared<OmplObjective>(si, model_)) {
    fieldEpoch_ = model_->field().epoch();
    specs_.optimizingPaths = true;
    specs_.canReportIntermediateSolutions = false;
    declareOption("range", growth_.range);
    declareOption("goal_bias", growth_.goalBias);
    declareOption("rewire_factor", growth_.rewireFactor);
    declareOption("max_vertices", growth_.maxVertices);
    declareOption("max_iterations", growth_.maxIterations);
    declareOption("time_limit", growth_.timeLimit);
    declareOption("seed", growth_.seed);
    const auto show = [this](const std::string& property, const auto& value) {
        addPlannerProgressProperty(property, [&value] { return std::to_string(value.load()); });
    };
    show("best cost REAL", progress_.cost);
    show("vertices INTEGER", progress_.vertices);
    show("iterations INTEGER", progress_.iterations);
    show("views INTEGER", progress_.views);
}

BeliefPlanner::~BeliefPlanner() { freeMemory(); }

void BeliefPlanner::setup() {
    Planner::setup();
    if (!neighbours_) {
        neighbours_ = std::make_shared<SeededNeighbours<Vertex*>>();
        neighbours_->setDistanceFunction(
            [this](const Vertex* a, const Vertex* b) { return si_->distance(a->state, b->state); });
    }
}

ob::PlannerStatus BeliefPlanner::solve(const ob::PlannerTerminationCondition& ptc) {
    return growth_.timeLimit > 0. ? solveFor(growth_.timeLimit, ptc) : solveUntil(ptc);
}

ob::PlannerStatus BeliefPlanner::solve(double seconds) {
    return solveFor(seconds, ob::plannerNonTerminatingCondition());
}

ob::PlannerStatus BeliefPlanner::solveFor(double seconds,
                                          const ob::PlannerTerminationCondition& ptc) {
    budget_ = std::clamp(seconds, 0., 1e9);
    deadline_ = now() + budget_;
    const struct Reset {  // also after an exception
        double& deadline;
        ~Reset() { deadline = kInfinity; }
    } reset{deadline_};
    const ob::PlannerTerminationCondition isOver([this] { return secondsLeft() <= 0.; });
    return solveUntil(ob::plannerOrTerminationCondition(ptc, isOver));
}

ob::PlannerStatus BeliefPlanner::solveUntil(const ob::PlannerTerminationCondition& ptc) {
    checkValidity();
    if (dynamic_cast<ob::GoalSampleableRegion*>(pdef_->getGoal().get()) == nullptr) {
        return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
    }
    try {
        if (!addStarts()) return ob::PlannerStatus::INVALID_START;
        if (!sampler_) {
            sampler_ = model_->space().sampler(growth_.seed);
            rng_.setLocalSeed(growth_.seed);
        }
        growUntil(ob::plannerOrTerminationCondition(
            ptc, ob::PlannerTerminationCondition(isInterrupted_)));
    } catch (const Interrupted&) {
        if (best_.states.empty() && !isInterrupted_()) throw;
    }
    countRewired();
    publishProgress();
    return report();
}

/// RRT* in one page, with grow(); compare the paper's Algorithm 1.
void BeliefPlanner::growUntil(const ob::PlannerTerminationCondition& ptc) {
    begin(ptc);
    growAroundBlocked();
    ob::ScopedState<> goalOrSample(si_);
    growToGoal(goalOrSample.get(), ptc);
    for (bool isTimeLeft = true; isTimeLeft;) {
        const std::size_t before = vertices();
        while (!ptc && !isGrown() && !isTimeToFinish()) {
            ++iterations_;
            grow(goalOrSample.get(), ptc);
            publishProgress();
        }
        const double left = secondsLeft();
        finish(ptc);
        isTimeLeft = hasDeadline() && !ptc && !isGrown() && vertices() > before &&
                     secondsLeft() > kAnotherRound * (left - secondsLeft());
    }
}

double BeliefPlanner::range() const {
    return growth_.range > 0. ? growth_.range : 0.2 * si_->getMaximumExtent();
}

std::size_t BeliefPlanner::mostVertices() const {
    return growth_.maxVertices + std::min<std::size_t>(forBlocked_, growth_.maxVertices);
}

bool BeliefPlanner::isGrown() const {
    return (growth_.maxVertices > 0 && samples() >= mostVertices()) ||
           (growth_.maxIterations > 0 &&
            iterations_ - iterationsAtChange_ >= growth_.maxIterations);
}

bool BeliefPlanner::isTimeToFinish() const {
    return hasDeadline() && secondsLeft() <= std::min(timeToFinish(), kMaxFinishShare * budget_);
}

/// A graph that has its largest number of vertices but no goal, which was not free before: some
/// more vertices toward it.
void BeliefPlanner::growToGoal(ob::State* goal, const ob::PlannerTerminationCondition& ptc) {
    const auto& region = *pdef_->getGoal()->as<ob::GoalSampleableRegion>();
    const std::size_t full = mostVertices();
    for (int i = 0; i < kGoalReserve && goals_.empty() && region.canSample() && !ptc; ++i) {
        if (full == 0 || samples() < full || samples() >= full + kGoalReserve) return;
        region.sampleGoal(goal);
        if (!si_->isValid(goal)) continue;
        ++iterations_;
        growToward(goal, true, ptc);
    }
}

/// One sample, and a new vertex toward it.
void BeliefPlanner::grow(ob::State* target, const ob::PlannerTerminationCondition& ptc) {
    const bool isGoalSample = sample(target);
    growToward(target, isGoalSample, ptc);
}

void BeliefPlanner::growToward(const ob::State* target, bool isGoalSample,
                               const ob::PlannerTerminationCondition& ptc) {
    const auto extension = extend(target);
    if (!extension) {
        if (++failures_ > kMostFailures) updated_.clear();
        return;
    }
    failures_ = 0;
    Vertex& fresh = *extension->fresh;
    const bool isReached = isGoalSample && si_->distance(fresh.state, target) == 0.;
    fresh.isGoal = isReached || pdef_->getGoal()->isSatisfied(fresh.state);
    if (fresh.isGoal) goals_.push_back(&fresh);
    connect(fresh, near(fresh, extension->nearest), ptc);
    if (isReached) goalSamples_.push_back(&fresh);  // unless a view has thrown: then once more
    neighbours_->add(&fresh);
    ++update_.verticesAdded;
    if (update_.verticesAdded == verticesToAdd()) updated_.clear();
}

void BeliefPlanner::publishProgress() {
    progress_.cost = bestCost();
    progress_.vertices = vertices();
    progress_.iterations = iterations();
    progress_.views = model_->field().views();
}

/// A start in collision is no root; when it is free, it becomes one.
/// @return whether there is a root that is free
bool BeliefPlanner::addStarts() {
    for (unsigned i = 0; i < pdef_->getStartStateCount(); ++i) {
        const ob::State* start = pdef_->getStartState(i);
        if (rootAt(start) != nullptr) continue;
        if (!si_->satisfiesBounds(start) || !si_->isValid(start)) {
            OMPL_WARN("%s: a start state is out of bounds or in collision", getName().c_str());
            continue;
        }
        const Belief belief = rootBelief(start);  // if a view throws, the start is no root yet
        Vertex& root = addVertex(start);
        root.isGoal = pdef_->getGoal()->isSatisfied(start);
        roots_.push_back({&root, belief});
        addRoot(roots_.back());
        neighbours_->add(&root);
        if (root.isGoal) offer(0., {root.state});
    }
    return std::any_of(roots_.begin(), roots_.end(),
                       [this](const Root& root) { return si_->isValid(root.vertex->state); });
}

/// A goal state now and then until all of them are vertices, else a uniform sample.
/// @return whether `state` is a goal state
bool BeliefPlanner::sample(ob::State* state) {
    const auto& goal = *pdef_->getGoal()->as<ob::GoalSampleableRegion>();
    if (goalSamples_.size() < goal.maxSampleCount() && goal.canSample() &&
        rng_.uniform01() < growth_.goalBias) {
        goal.sampleGoal(state);
        if (si_->isValid(state)) return true;
    }
    const bool isUpdated =
        updated_.sample(state, sampleShares(), connectionRadius(), *sampler_, rng_);
    if (!isUpdated) sampler_->sampleUniform(state);
    return false;
}

/// A vertex at most range() from the nearest one toward the target, if the way is free.
std::optional<BeliefPlanner::Extension> BeliefPlanner::extend(const ob::State* target) {
    Vertex probe;
    probe.state = const_cast<ob::State*>(target);
    Vertex* nearest = neighbours_->nearest(&probe);
    const double distance = si_->distance(nearest->state, target);
    if (distance == 0.) return {};
    if (!isPromising(*nearest) && rng_.uniform01() >= kExploration) return {};

    Vertex& fresh = addVertex(target);
    if (distance > range()) {
        si_->getStateSpace()->interpolate(nearest->state, target, range() / distance, fresh.state);
    }
    if (!motionIsFree(*nearest, fresh)) {
        release(fresh);
        return {};
    }
    return Extension{&fresh, nearest};
}

/// gamma (log n / n)^(1/d) (Karaman and Frazzoli 2011).
double BeliefPlanner::connectionRadius() const {
    const auto& space = model_->space();
    const double d = space.dimension();
    const double n = static_cast<double>(vertices());
    const double gamma =
        growth_.rewireFactor *
        std::pow(2. * (1. + 1. / d) * space.measure() / space.unitBallMeasure(), 1. / d);
    return std::min(range(), gamma * std::pow(std::log(n) / n, 1. / d));
}

std::vector<Vertex*> BeliefPlanner::near(const Vertex& fresh, Vertex* nearest) const {
    std::vector<Vertex*> neighbourhood;
    neighbours_->nearestR(const_cast<Vertex*>(&fresh), connectionRadius(), neighbourhood);
    const auto it = std::find(neighbourhood.begin(), neighbourhood.end(), nearest);
    if (it == neighbourhood.end())
        neighbourhood.insert(neighbourhood.begin(), nearest);
    else
        std::swap(*it, neighbourhood.front());
    return neighbourhood;
}

Vertex& BeliefPlanner::addVertex(const ob::State* state) {
    if (unused_.empty()) {
        unused_.push_back(&vertices_.emplace_back());
        unused_.back()->index = static_cast<std::uint32_t>(vertices_.size() - 1);
    }
    Vertex& vertex = *unused_.back();
    unused_.pop_back();
    vertex = {si_->cloneState(state), vertex.index, false};
    return vertex;
}

void BeliefPlanner::release(Vertex& vertex) {
    si_->freeState(vertex.state);
    vertex.state = nullptr;
    unused_.push_back(&vertex);
}

void BeliefPlanner::remove(const std::vector<Vertex*>& vertices) {
    update_.verticesInvalidated += vertices.size();
    for (const Vertex* vertex : vertices) updated_.addRemoved(vertex->state);
    erase(vertices);
}

void BeliefPlanner::erase(const std::vector<Vertex*>& vertices) {
    forgetParents(vertices);
    for (Vertex* vertex : vertices) {
        removeEdgesOf(*vertex);
        neighbours_->remove(vertex);
        std::erase(goals_, vertex);
        std::erase(goalSamples_, vertex);
        std::erase(movedRoots_, vertex);
        release(*vertex);
    }
}

void BeliefPlanner::offer(double cost, const std::vector<const ob::State*>& path) {
    if (cost < best_.cost) replaceBest(cost, path);
}

void BeliefPlanner::replaceBest(double cost, const std::vector<const ob::State*>& path) {
    si_->freeStates(best_.states);
    best_.states.clear();
    for (const ob::State* state : path) best_.states.push_back(si_->cloneState(state));
    best_.cost = cost;
}

ob::PlannerStatus BeliefPlanner::report() {
    if (best_.states.empty()) return ob::PlannerStatus::TIMEOUT;
    addSolution();
    return ob::PlannerStatus::EXACT_SOLUTION;
}

void BeliefPlanner::addSolution() {
    auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
    for (const ob::State* state : best_.states) path->append(state);
    ob::PlannerSolution solution(path);
    solution.setPlannerName(getName());
    solution.setOptimized(objective_, ob::Cost(best_.cost), false);
    pdef_->addSolutionPath(solution);
}

void BeliefPlanner::clear() {
    Planner::clear();
    freeMemory();
    vertices_.clear();
    roots_.clear();
    goals_.clear();
    best_ = {kInfinity, {}};
    sampler_.reset();
    if (neighbours_) neighbours_->clear();
    iterations_ = iterationsAtChange_ = 0;
    goalSamples_.clear();
    movedRoots_.clear();
    forBlocked_ = forBlockedNow_ = 0;
    blockedCost_ = kInfinity;
    unused_.clear();
    updated_.clear();
    update_ = {};
    isSolved_ = false;
    parentsBefore_.clear();
    movedRoot_.reset();
    model_->clear();
    fieldEpoch_ = model_->field().epoch();
    publishProgress();
}

void BeliefPlanner::freeMemory() {
    for (Vertex& vertex : vertices_) {
        if (vertex.state != nullptr) si_->freeState(vertex.state);
    }
    si_->freeStates(best_.states);
    best_.states.clear();
    dropBlocked();
}

void BeliefPlanner::getPlannerData(ob::PlannerData& data) const {
    Planner::getPlannerData(data);
    const auto nodes = tree();
    for (const TreeNode& node : nodes) {
        if (node.parent < 0) {
            data.addStartVertex(ob::PlannerDataVertex(node.state));
        } else {
            const ob::State* parent = nodes[node.parent].state;
            data.addEdge(ob::PlannerDataVertex(parent), ob::PlannerDataVertex(node.state), {},
                         ob::Cost(si_->distance(parent, node.state)));
        }
    }
    for (const Vertex* goal : goals_) data.markGoalState(goal->state);
}

}  // namespace photonav
