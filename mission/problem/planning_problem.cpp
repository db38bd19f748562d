// SPDX-License-Identifier: BSD-3-Clause
#include "problem/planning_problem.hpp"

#include <fmt/format.h>
#include <ompl/base/goals/GoalStates.h>

#include <numbers>
#include <utility>

#include "belief/view_model_table.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "planners/planner_table.hpp"
#include "planners/shortened_path.hpp"
#include "problem/tree_evolution.hpp"
#include "render/interruptible_views.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr int kFreeHeadings = 8;               // goals offered where the goal has no yaw
constexpr std::size_t kProgressInterval = 50;  // vertices
constexpr double kShowInterval = 0.5;          // of progress without new vertices [s]
constexpr std::size_t kMaxSamples = 200;       // per requested vertex: beyond, planning gives up
constexpr std::size_t kMostExactViews = 1000;  // kept when the map changes: a few paths

// Where views only rank, it is not worth many of them to find the best path of the roadmap: the
// descent from any good one gains more.
constexpr double kInflationByQuickViews = 0.7;

/// Cells so small that the view from a cell is that from any pose in it.
constexpr InformationField::Options kExactPoses{.positionPitch = 1e-6, .rotationPitch = 1e-6};

/// The solution may come from an earlier tree than the one audited.
void includePath(Audit& audit, double stored, double replayed) {
    const double error = std::abs(stored - replayed) / (1. + replayed);
    if (!(error <= audit.maxCostError)) audit.maxCostError = error;
}

Config withAlpha(Config config, double alpha) {
    config.belief.alpha = alpha;
    return config;
}

}  // namespace

PlanningProblem::PlanningProblem(const Config& config, const World& world,
                                 std::optional<double> alpha, MakeInformationModel photometric)
    : config_(withAlpha(config, alpha.value_or(config.belief.alpha))),
      world_(world),
      notFollowed_(world.collectChanges()),
      photometric_(std::move(photometric)),
      space_(config.space, config.bounds, config.rotationWeight, config.start.yaw.value_or(0.)),
      si_(makeSpaceInformation(
          space_, [&world](const Eigen::Vector3d& p_w) { return world.clearance(p_w); },
          config.robotRadius)),
      field_(makeField("photometric")),
      plannersField_(hasQuickViews()                          ? makeQuickField()
                     : config.viewModel.name == "photometric" ? field_
                                                              : makeField(config.viewModel.name)),
      evaluator_(std::make_shared<BeliefModel>(space_, field_, optionsWith(config_.belief.kappa))) {
}

PlanningProblem::PlanningProblem(const PlanningProblem& other, double alpha)
    : config_(withAlpha(other.config_, alpha)),
      world_(other.world_),
      notFollowed_(world_.collectChanges()),
      interruption_(other.interruption_),
      photometric_(other.photometric_),
      space_(other.space_),
      si_(other.si_),
      field_(other.field_),
      plannersField_(other.plannersField_),
      evaluator_(std::make_shared<BeliefModel>(space_, field_, optionsWith(config_.belief.kappa))) {
    *notFollowed_ = *other.notFollowed_;
}

void PlanningProblem::checkPlaces() const {
    checkPlace("start", config_.start);
    checkPlace("goal", config_.goal);
}

bool PlanningProblem::isFlyable(const Eigen::Vector3d& p_w) const {
    return world_.clearance(p_w) > config_.robotRadius;
}

void PlanningProblem::checkPlace(const std::string& key, const Place& place) const {
    if (isFlyable(place.position)) return;
    const auto known = world_.distancesWithoutUnknown(config_);
    const bool isUnknown = known && known->clearance(place.position) > config_.robotRadius;
    throw config_.invalid(
        key, fmt::format("in collision: clearance {:.3f} m, robot.radius {} m{}",
                         world_.clearance(place.position), config_.robotRadius,
                         isUnknown ? ", next to unknown cells (map.unknown: occupied)" : ""));
}

std::string PlanningProblem::statusOf(const PlanOutcome& outcome) const {
    const std::string status = outcome.status();
    if (outcome.isSolved()) return status;
    if (outcome.path) return status + ": the cost of the path is not a finite number";
    if (outcome.vertices >= config_.vertices) {
        return fmt::format("{}: the goal was not reached by {} vertices", status, outcome.vertices);
    }
    return fmt::format("{}: {} vertices after {} samples, then given up", status, outcome.vertices,
                       outcome.iterations);
}

PlanOutcome PlanningProblem::solve(const std::string& name, const std::atomic<bool>& interrupted,
                                   const OnPlanProgress& onProgress) {
    kappa(interrupted);
    return solve(makePlanner(name), interrupted, onProgress);
}

PlanOutcome PlanningProblem::solve(const std::shared_ptr<BeliefPlanner>& planner,
                                   const std::atomic<bool>& interrupted,
                                   const OnPlanProgress& onProgress) {
    const Stopwatch watch;
    const BeliefModel& model = planner->model();
    PlanOutcome outcome;
    outcome.progress = grow(*planner, interrupted, onProgress);
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
    const InterruptionScope scope = interruptedBy(interrupted);
    try {
        judge(*planner, outcome);
    } catch (const Interrupted&) {  // views that the planner has not rendered
        outcome.path.reset();
    }
    return outcome;
}

std::vector<PlanProgress> PlanningProblem::grow(BeliefPlanner& planner,
                                                const std::atomic<bool>& interrupted,
                                                const OnPlanProgress& onProgress) {
    const Stopwatch watch;
    std::vector<PlanProgress> steps;
    const auto progress = [&] {
        return PlanProgress{planner.vertices(), watch.seconds(), planner.bestCost(),
                            planner.model().field().views()};
    };
    double shown = 0.;  // [s]
    const auto show = [&](const PlanProgress& now) {
        shown = now.seconds;
        if (onProgress) onProgress(now);
    };
    std::size_t next = kProgressInterval;
    const auto isDone = [&] {
        if (planner.vertices() >= next) {
            show(steps.emplace_back(progress()));
            next = planner.vertices() + kProgressInterval;
        } else if (watch.seconds() > shown + kShowInterval) {  // in the last search and descent
            show(progress());
        }
        return interrupted.load();
    };
    const InterruptionScope scope = interruptedBy(interrupted);
    planner.solve(ob::PlannerTerminationCondition(isDone));
    show(steps.emplace_back(progress()));
    return steps;
}

/// Checks the tree, and evaluates the path.
void PlanningProblem::judge(const BeliefPlanner& planner, PlanOutcome& outcome) {
    outcome.audit = auditTree(planner);
    const auto& path = planner.bestPath();
    if (path.empty()) return;
    outcome.plannerCost = planner.bestCost();
    const auto replayed = planner.model().evaluate({path.begin(), path.end()}, planner.movedRoot());
    includePath(outcome.audit, outcome.plannerCost, replayed.back().cost);
    outcome.path = evaluate(planner);
}

/// The path of rrt_star without most of the corners that depend on its samples.
ompl::geometric::PathGeometric PlanningProblem::shortestPath(const BeliefPlanner& planner) const {
    return shortenPath(
        si_, space_, planner.bestPath(), config_.search.shortcut,
        ob::PlannerTerminationCondition([this] { return (*interruption_)->load(); }));
}

std::shared_ptr<BeliefPlanner> PlanningProblem::makePlanner(const std::string& name,
                                                            std::optional<std::uint32_t> seed) {
    return makePlanner(name, plannersModel(), seed.value_or(config_.seed));
}

std::shared_ptr<BeliefPlanner> PlanningProblem::makePlanner(
    const std::string& name, const std::shared_ptr<BeliefModel>& model, std::uint32_t seed) {
    GrowthOptions growth = config_.growth;
    growth.seed = seed;
    growth.obstacleReach = config_.robotRadius;
    growth.maxVertices = config_.vertices;
    growth.maxIterations = kMaxSamples * config_.vertices;
    SearchOptions search = config_.search;
    if (hasQuickViews()) search.inflation = kInflationByQuickViews;
    auto planner = photonav::makePlanner(name, si_, model, search, growth);
    if (hasQuickViews()) planner->setReferenceModel(evaluator_);
    planner->setProblemDefinition(definition());
    planner->setup();
    std::erase_if(planners_, [](const auto& made) { return made.expired(); });
    planners_.push_back(planner);
    return planner;
}

/// The change is kept until all have followed it: what an exception leaves out follows next time.
void PlanningProblem::followMap() {
    const MapChange& change = *notFollowed_;
    const auto views = interruptibleViews();
    if (hasQuickViews() && field_->size() > kMostExactViews) field_->forget();
    field_->update(views, change);
    if (plannersField_ != field_) plannersField_->update(views, change);
    for (const auto& made : planners_) {
        if (const auto planner = made.lock()) planner->mapChanged(change);
    }
    *notFollowed_ = {};
}

std::shared_ptr<const ViewSource> PlanningProblem::interruptibleViews() const {
    return std::make_shared<InterruptibleViews>(world_.sharedViews(),
                                                [flag = interruption_] { return (*flag)->load(); });
}

std::shared_ptr<InformationField> PlanningProblem::makeField(const std::string& viewModel) const {
    const Camera camera = config_.camera.camera();
    const Pose T_b_c = config_.camera.T_b_c();
    const auto field = [&](const auto& model) {
        if constexpr (std::is_same_v<std::decay_t<decltype(model)>, std::monostate>) {
            return std::make_shared<InformationField>(InformationFormula{}, T_b_c, config_.field);
        } else {
            return std::make_shared<InformationField>(
                interruptibleViews(), camera, model, T_b_c,
                hasQuickViews() ? kExactPoses : config_.field);
        }
    };
    if (!world_.hasTexture()) return field(std::monostate());
    return std::visit(field, makeViewModel(viewModel, camera,
                                           {.photometric = config_.photometric,
                                            .features = config_.viewModel.features,
                                            .map = {.priorSigma = config_.viewModel.mapPriorSigma,
                                                    .baseline = config_.belief.ds},
                                            .makePhotometric = photometric_}));
}

bool PlanningProblem::hasQuickViews() const {
    return config_.quickViews && config_.viewModel.name == "photometric" && world_.hasTexture();
}

/// Half the size is a quarter of the time. Without the point spread, and with gradients over as
/// much of the surface as those of a whole view, each pixel stands for the four of a whole view.
std::shared_ptr<InformationField> PlanningProblem::makeQuickField() const {
    Camera camera = scaled(config_.camera.camera(), 0.5);
    camera.hasPointSpread = false;
    PhotometricOptions options = config_.photometric;
    options.gradient = GradientStencil::square;
    options.scale *= 4.;
    return std::make_shared<InformationField>(interruptibleViews(), camera,
                                              photometric_(camera, options), config_.camera.T_b_c(),
                                              config_.field);
}

BeliefOptions PlanningProblem::optionsWith(double kappa) const {
    BeliefOptions options = config_.belief;
    options.kappa = isAutomatic(kappa) ? 0. : kappa;
    return options;
}

std::shared_ptr<BeliefModel> PlanningProblem::plannersModel() {
    const double weight = plannersField_->hasPenalties() ? config_.viewModel.kappa : kappa();
    return std::make_shared<BeliefModel>(space_, plannersField_, optionsWith(weight));
}

ob::ProblemDefinitionPtr PlanningProblem::definition() const {
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

}  // namespace photonav
