// SPDX-License-Identifier: BSD-3-Clause
#include "belief_planner.hpp"

#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/datastructures/NearestNeighborsGNATNoThreadSafety.h>
#include <ompl/geometric/PathGeometric.h>

#include <cmath>

#include "constants.hpp"
#include "path_cost_objective.hpp"

namespace photonav {
namespace ob = ompl::base;

constexpr double kExploration = 0.2;  // share of the samples taken wherever they fall

namespace {

/// OMPL's tree of neighbours draws its pivots by a seed from the clock, and which of two vertices
/// at the same distance comes first depends on them. Here the seed is always the same.
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
      best_{kInfinity, {}},
      objective_(std::make_shared<PathCostObjective>(si, model_)) {
    specs_.optimizingPaths = true;
    specs_.canReportIntermediateSolutions = false;
    const auto declare = [this](const std::string& key, auto& value) {
        using T = std::decay_t<decltype(value)>;
        params_.declareParam<T>(
            key, [&value](T v) { value = v; }, [&value] { return value; });
    };
    declare("range", growth_.range);
    declare("goal_bias", growth_.goalBias);
    declare("rewire_factor", growth_.rewireFactor);
    declare("max_vertices", growth_.maxVertices);
    declare("max_iterations", growth_.maxIterations);
    declare("seed", growth_.seed);
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

/// RRT* in one page; compare the paper's Algorithm 1.
ob::PlannerStatus BeliefPlanner::solve(const ob::PlannerTerminationCondition& ptc) {
    checkValidity();
    if (dynamic_cast<ob::GoalSampleableRegion*>(pdef_->getGoal().get()) == nullptr) {
        return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
    }
    range_ = growth_.range > 0. ? growth_.range : 0.2 * si_->getMaximumExtent();
    if (!addStarts()) return ob::PlannerStatus::INVALID_START;
    if (!sampler_) {
        sampler_ = model_->space().sampler(growth_.seed);
        rng_.setLocalSeed(growth_.seed);
    }

    ob::ScopedState<> goalOrSample(si_);
    ob::State* target = goalOrSample.get();
    while (!ptc && !isGrown()) {
        ++iterations_;
        const bool isGoal = sample(target);
        Vertex* fresh = extend(target);
        if (fresh == nullptr) continue;
        if (isGoal && si_->distance(fresh->state, target) == 0.) {
            fresh->isGoal = true;
            ++goalSamples_;
        }
        fresh->isGoal = fresh->isGoal || pdef_->getGoal()->isSatisfied(fresh->state);
        if (fresh->isGoal) goals_.push_back(fresh);
        const auto neighbourhood = near(*fresh, fresh->parent);
        fresh->parent = nullptr;
        connect(*fresh, neighbourhood, ptc);
        neighbours_->add(fresh);
        publishProgress();
    }
    finish(ptc);
    publishProgress();
    return report();
}

void BeliefPlanner::publishProgress() {
    progress_.cost = bestCost();
    progress_.vertices = vertices();
    progress_.iterations = iterations();
    progress_.views = model_->field().views();
}

bool BeliefPlanner::addStarts() {
    while (const ob::State* start = pis_.nextStart()) {
        Vertex& root = addVertex(start);
        root.belief = model_->root();
        root.isGoal = pdef_->getGoal()->isSatisfied(start);
        starts_.push_back(&root);
        neighbours_->add(&root);
        if (root.isGoal) offer(0., {root.state});
    }
    return !starts_.empty();
}

/// A goal state now and then until all of them are vertices, else a uniform sample.
/// @return whether `state` is a goal state
bool BeliefPlanner::sample(ob::State* state) {
    const auto& goal = *pdef_->getGoal()->as<ob::GoalSampleableRegion>();
    if (goalSamples_ < goal.maxSampleCount() && goal.canSample() &&
        rng_.uniform01() < growth_.goalBias) {
        goal.sampleGoal(state);
        if (si_->isValid(state)) return true;
    }
    sampler_->sampleUniform(state);
    return false;
}

/// Nearest vertex, at most `range` toward the target, if the way is free. The new vertex remembers
/// the vertex it came from as its parent.
Vertex* BeliefPlanner::extend(const ob::State* target) {
    Vertex probe;
    probe.state = const_cast<ob::State*>(target);
    Vertex* nearest = neighbours_->nearest(&probe);
    const double distance = si_->distance(nearest->state, target);
    if (distance == 0.) return nullptr;
    if (!isPromising(*nearest) && rng_.uniform01() >= kExploration) return nullptr;

    Vertex& fresh = addVertex(target);
    if (distance > range_) {
        si_->getStateSpace()->interpolate(nearest->state, target, range_ / distance, fresh.state);
    }
    if (!motionIsFree(*nearest, fresh)) {
        si_->freeState(fresh.state);
        vertices_.pop_back();
        return nullptr;
    }
    fresh.parent = nearest;
    return &fresh;
}

/// Neighbours within gamma (log n / n)^(1/d) (Karaman and Frazzoli 2011), `nearest` in front.
std::vector<Vertex*> BeliefPlanner::near(const Vertex& fresh, Vertex* nearest) const {
    const auto& space = model_->space();
    const double d = space.dimension();
    const double n = static_cast<double>(vertices_.size());
    const double gamma =
        growth_.rewireFactor *
        std::pow(2. * (1. + 1. / d) * space.measure() / space.unitBallMeasure(), 1. / d);
    const double radius = std::min(range_, gamma * std::pow(std::log(n) / n, 1. / d));
    std::vector<Vertex*> neighbourhood;
    neighbours_->nearestR(const_cast<Vertex*>(&fresh), radius, neighbourhood);
    const auto it = std::find(neighbourhood.begin(), neighbourhood.end(), nearest);
    if (it == neighbourhood.end())
        neighbourhood.insert(neighbourhood.begin(), nearest);
    else
        std::swap(*it, neighbourhood.front());
    return neighbourhood;
}

Vertex& BeliefPlanner::addVertex(const ob::State* state) {
    Vertex& vertex = vertices_.emplace_back();
    vertex.state = si_->cloneState(state);
    vertex.index = static_cast<std::uint32_t>(vertices_.size() - 1);
    return vertex;
}

void BeliefPlanner::offer(double cost, const std::vector<const ob::State*>& path) {
    if (cost >= best_.cost) return;
    si_->freeStates(best_.states);
    best_.states.clear();
    for (const ob::State* state : path) best_.states.push_back(si_->cloneState(state));
    best_.cost = cost;
}

ob::PlannerStatus BeliefPlanner::report() {
    if (best_.states.empty()) return ob::PlannerStatus::TIMEOUT;
    auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
    for (const ob::State* state : best_.states) path->append(state);
    ob::PlannerSolution solution(path);
    solution.setPlannerName(getName());
    solution.setOptimized(objective_, ob::Cost(best_.cost), false);
    pdef_->addSolutionPath(solution);
    return ob::PlannerStatus::EXACT_SOLUTION;
}

void BeliefPlanner::clear() {
    Planner::clear();
    freeMemory();
    vertices_.clear();
    starts_.clear();
    goals_.clear();
    best_ = {kInfinity, {}};
    sampler_.reset();
    if (neighbours_) neighbours_->clear();
    iterations_ = 0;
    goalSamples_ = 0;
    model_->clear();
    publishProgress();
}

void BeliefPlanner::freeMemory() {
    for (Vertex& vertex : vertices_) si_->freeState(vertex.state);
    si_->freeStates(best_.states);
    best_.states.clear();
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
