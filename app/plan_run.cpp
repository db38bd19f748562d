// SPDX-License-Identifier: BSD-3-Clause
#include "plan_run.hpp"

#include <fmt/format.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathGeometric.h>

#include <numbers>

#include "belief_rrt_star.hpp"
#include "error.hpp"
#include "perception_rrt_star.hpp"
#include "rrbt.hpp"
#include "se3.hpp"
#include "stopwatch.hpp"
#include "tree_evolution.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr int kFreeHeadings = 8;               // goals offered where the goal has no yaw
constexpr std::size_t kProgressInterval = 50;  // vertices
constexpr std::size_t kMostSamples = 200;      // per vertex asked for: most are in vain, give up

/// The answer may come from an earlier tree than the one audited.
void includePath(Audit& audit, double stored, double replayed) {
    const double error = std::abs(stored - replayed) / (1. + replayed);
    if (!(error <= audit.maxCostError)) audit.maxCostError = error;
}

std::vector<const ob::State*> solutionOf(const BeliefPlanner& planner) {
    const auto path = planner.getProblemDefinition()->getSolutionPath();
    const auto& states = path->as<ompl::geometric::PathGeometric>()->getStates();
    return {states.begin(), states.end()};
}

}  // namespace

PlanRun::PlanRun(const Config& config, const World& world)
    : config_(config),
      world_(world),
      space_(config.space, config.bounds, config.rotationWeight, config.start.yaw.value_or(0.)),
      si_(makeSpaceInformation(
          space_, [&world](const Eigen::Vector3d& p_w) { return world.clearance(p_w); },
          config.robotRadius)),
      field_(makeField("photometric")),
      plannersField_(config.viewModel.name == "photometric" ? field_
                                                            : makeField(config.viewModel.name)),
      judge_(makeModel(field_, config.planner == "rrt_star" ? 1. : config.belief.alpha)) {}

void PlanRun::checkPlaces() const {
    checkPlace("start", config_.start);
    checkPlace("goal", config_.goal);
}

bool PlanRun::isFlyable(const Eigen::Vector3d& p_w) const {
    return world_.clearance(p_w) > config_.robotRadius;
}

void PlanRun::checkPlace(const std::string& key, const Place& place) const {
    if (isFlyable(place.position)) return;
    throw InputError(config_.file, key,
                     fmt::format("in collision: clearance {:.3f} m, robot.radius {} m",
                                 world_.clearance(place.position), config_.robotRadius));
}

std::string PlanRun::statusOf(const PlanOutcome& outcome) const {
    return outcome.path ? "done" : reasonForNoPath(outcome.vertices, outcome.iterations);
}

std::string PlanRun::reasonForNoPath(std::size_t vertices, std::size_t iterations) const {
    if (vertices >= config_.vertices) {
        return fmt::format("no path: the goal was not reached by {} vertices", vertices);
    }
    return fmt::format("no path: {} vertices after {} samples, then given up", vertices,
                       iterations);
}

PlanOutcome PlanRun::solve(const std::string& name, const std::atomic<bool>& interrupted,
                           const std::function<void(const ReportProgress&)>& onProgress) {
    const Stopwatch watch;
    const auto planner = makePlanner(name);
    const BeliefModel& model = planner->model();
    PlanOutcome outcome;
    const auto report = [&] {
        outcome.progress.push_back(
            {planner->vertices(), watch.seconds(), planner->bestCost(), model.field().views()});
        onProgress(outcome.progress.back());
    };
    std::size_t next = kProgressInterval;
    const auto isDone = [&] {
        if (planner->vertices() >= next) {
            report();
            next = planner->vertices() + kProgressInterval;
        }
        return interrupted.load();
    };
    planner->solve(ob::PlannerTerminationCondition(isDone));
    report();

    outcome.alpha = model.options().alpha;
    outcome.vertices = planner->vertices();
    outcome.iterations = planner->iterations();
    outcome.views = model.field().views();
    outcome.cacheHits = model.field().cacheHits();
    outcome.fallbacks = model.fallbacks();
    outcome.planSeconds = watch.seconds();
    outcome.viewSeconds = model.field().seconds();
    outcome.beliefSeconds = model.seconds();
    outcome.tree = drawnEdges(*planner);
    outcome.audit = auditTree(*planner);
    if (planner->getProblemDefinition()->hasExactSolution()) {
        outcome.path = judge(*planner);
        outcome.plannerCost = planner->bestCost();
        const double replayed = planner->model().evaluate(solutionOf(*planner)).back().cost;
        includePath(outcome.audit, outcome.plannerCost, replayed);
    }
    return outcome;
}

std::shared_ptr<BeliefPlanner> PlanRun::makePlanner(const std::string& name) const {
    GrowthOptions growth = config_.growth;
    growth.seed = config_.seed;
    growth.maxVertices = config_.vertices;
    growth.maxIterations = kMostSamples * config_.vertices;
    const auto model = makeModel(plannersField_, name == "rrt_star" ? 1. : config_.belief.alpha);
    std::shared_ptr<BeliefPlanner> planner;
    if (name == "belief_rrt_star") {
        planner = std::make_shared<BeliefRRTstar>(si_, model, config_.search, growth);
    } else if (name == "rrbt") {
        planner = std::make_shared<RRBT>(si_, model, growth);
    } else {
        planner = std::make_shared<PerceptionRRTstar>(si_, model, growth);
    }
    planner->setProblemDefinition(definition());
    planner->setup();
    return planner;
}

std::shared_ptr<InformationField> PlanRun::makeField(const std::string& viewModel) const {
    const Camera camera = config_.camera.camera();
    const auto field = [&](auto model) {
        return std::make_shared<InformationField>(std::move(model), config_.camera.T_b_c(),
                                                  config_.field);
    };
    if (viewModel == "none" || !world_.hasTexture()) return field(InformationModel{});
    const FeatureOptions& features = config_.viewModel.features;
    if (viewModel == "feature_reprojection") {
        return field(featureReprojectionModel(world_.views(), camera, features));
    }
    if (viewModel == "feature_count") {
        return field(featureCountModel(world_.views(), camera, features));
    }
    if (viewModel == "map_uncertainty") {
        return field(mapUncertaintyModel(
            world_.views(), camera, config_.photometric,
            {.priorSigma = config_.viewModel.mapPriorSigma, .baseline = config_.belief.ds}));
    }
    return field(photometricModel(world_.views(), camera, config_.photometric));
}

std::shared_ptr<BeliefModel> PlanRun::makeModel(std::shared_ptr<InformationField> field,
                                                double alpha) const {
    BeliefOptions options = config_.belief;
    options.alpha = alpha;
    if (field->hasPenalties()) options.kappa = config_.viewModel.kappa;
    return std::make_shared<BeliefModel>(space_, std::move(field), options);
}

ob::ProblemDefinitionPtr PlanRun::definition() const {
    auto definition = std::make_shared<ob::ProblemDefinition>(si_);
    ob::ScopedState<> state(si_);
    space_.setState(state.get(), config_.start.position, config_.start.yaw.value_or(0.));
    definition->addStartState(state);
    const bool anyHeading = config_.space != StateKind::position && !config_.goal.yaw;
    auto goals = std::make_shared<ob::GoalStates>(si_);
    for (int i = 0; i < (anyHeading ? kFreeHeadings : 1); ++i) {
        const double yaw =
            config_.goal.yaw.value_or(0.) + 2. * std::numbers::pi * i / kFreeHeadings;
        space_.setState(state.get(), config_.goal.position, yaw);
        goals->addState(state);
    }
    definition->setGoal(goals);
    return definition;
}

std::optional<JudgedPath> PlanRun::descend(const std::vector<Pose>& waypoints,
                                           const DescentOptions& options,
                                           const std::atomic<bool>& interrupted) {
    ompl::geometric::PathGeometric path(si_);
    ob::ScopedState<> state(si_);
    for (const Pose& T_w_b : waypoints) {
        space_.setState(state.get(), T_w_b.translation(), yawOf(T_w_b));
        path.append(state.get());
    }
    if (waypoints.empty() || !path.check()) return std::nullopt;
    PathDescent descent(si_, judge_, options);
    descent.begin({path.getStates().begin(), path.getStates().end()});
    descent.descend(ob::PlannerTerminationCondition([&] { return interrupted.load(); }));
    return judge("descent", descent.path());
}

JudgedPath PlanRun::judge(const BeliefPlanner& planner) {
    return judge(planner.getName(), solutionOf(planner));
}

JudgedPath PlanRun::judge(const std::string& planner, const std::vector<Place>& waypoints) {
    std::vector<ob::ScopedState<>> states;
    std::vector<const ob::State*> pointers;
    states.reserve(waypoints.size());
    pointers.reserve(waypoints.size());
    for (const Place& place : waypoints) {
        pointers.push_back(states.emplace_back(si_).get());
        space_.setState(states.back().get(), place.position, place.yaw.value_or(0.));
    }
    return judge(planner, pointers);
}

JudgedPath PlanRun::judge(const std::string& planner, const std::vector<const ob::State*>& path) {
    JudgedPath judged{.planner = planner, .points = judge_->evaluate(path)};
    double integral = 0.;
    for (std::size_t i = 1; i < judged.points.size(); ++i) {
        const BeliefPoint& last = judged.points[i - 1];
        const BeliefPoint& next = judged.points[i];
        integral += 0.5 * (next.distance - last.distance) * (last.trace + next.traceBefore);
    }
    const BeliefPoint& goal = judged.points.back();
    judged.cost = goal.cost;
    judged.length = goal.length;
    judged.meanTrace = goal.distance > 0. ? integral / goal.distance : goal.trace;
    judged.goalTrace = goal.trace;
    return judged;
}

}  // namespace photonav
