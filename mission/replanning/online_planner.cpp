// SPDX-License-Identifier: BSD-3-Clause
#include "replanning/online_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "alignment/residual_covariance.hpp"
#include "geometry/rotation_information.hpp"
#include "geometry/se3.hpp"
#include "geometry/segment.hpp"
#include "io/stopwatch.hpp"
#include "planners/planner_table.hpp"
#include "planners/shortened_path.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

// A planner that looks at nothing gets the time that views take of others: so many times the
// vertices, and changes by which its path is smoothed.
constexpr unsigned kVerticesWithoutViews = 10;
constexpr unsigned kChangesWithoutViews = 1000;
/// After so many updates without a way the tree is grown anew, which takes as long as ten of them.
constexpr int kAnew = 3;

/// Covariance of the motion that odometry and gyroscope measure, per metre of flight.
Matrix6 motionNoiseOf(const Config& config) {
    const double noise = config.explore.gyroscopeNoise;
    if (noise == 0.) return config.belief.motionNoise;
    return updateCovariance(config.belief.motionNoise,
                            rotationInformation(noise * noise / config.fly.speed));
}

/// The config of plans in a map that grows. A view stands for a cell of twice the size: most views
/// are seen once before the map changes again.
Config configOf(Config config, const std::string& planner) {
    config.vertices = config.explore.vertices;
    if (!usesViews(planner)) config.vertices *= kVerticesWithoutViews;
    config.search.shortcut = config.explore.shortcut;
    config.search.commitment = config.explore.commitment;
    config.quickViews = true;
    config.field.positionPitch *= 2.;
    config.field.rotationPitch *= 2.;
    config.field.updatesUntilStale = config.explore.viewTurns;
    config.belief.initialCovariance = config.explore.initialCovariance;
    config.belief.motionNoise = motionNoiseOf(config);
    config.unknownToCamera = UnknownPolicy::free;
    config.unknownToPlanner = config.explore.unknown == UnknownSpace::optimistic
                                  ? UnknownPolicy::free
                                  : UnknownPolicy::occupied;
    return config;
}

std::shared_ptr<ob::State> copyOf(const ob::SpaceInformationPtr& si, const ob::State* state) {
    return {si->cloneState(state), [si](ob::State* copy) { si->freeState(copy); }};
}

}  // namespace

/// PlanningLimits with a clock that runs from the construction.
class OnlinePlanner::Limits {
  public:
    explicit Limits(const PlanningLimits& limits) : limits_(limits) {}
    bool isInterrupted() const { return limits_.interrupted; }
    /// @param hasPath whether there is a path that could be improved
    bool isOver(bool hasPath) const {
        if (isInterrupted()) return true;
        if (hasPath && watch_.seconds() > limits_.seconds) isClockOver_ = true;
        return hasPath && isClockOver_;
    }
    bool isClockOver() const { return isClockOver_; }  ///< it has ended an improvement

  private:
    const PlanningLimits& limits_;
    Stopwatch watch_;
    mutable bool isClockOver_ = false;
};

OnlinePlanner::OnlinePlanner(const Config& config, const OnlineMap& map, const ExplorePlanner& kind,
                             std::uint32_t seed)
    : config_(configOf(config, kind.name)),
      world_(map.cells(), map.obstacles(), config_),
      problem_(config_, world_, alphaOf(kind.name, config_.belief.alpha),
               [&map](const Camera& camera, const PhotometricOptions& options) {
                   return map.information(camera, options);
               }),
      kind_(kind),
      seed_(seed),
      planner_(problem_.makePlanner(kind.name, seed)) {}

/// Whether a robot that is too near to obstacles comes no nearer on the way: not through a wall.
bool OnlinePlanner::isWayOut(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const {
    constexpr double kSpacing = 0.02, kRounding = 1e-3;  // [m]
    const int steps = static_cast<int>((to_w - from_w).norm() / kSpacing) + 1;
    const double least = std::min(clearance(from_w), config_.robotRadius) - kRounding;
    for (int i = 1; i < steps; ++i) {
        if (clearance(from_w + (to_w - from_w) * i / steps) < least) return false;
    }
    return true;
}

/// The nearest place around that leaves room for the robot; nothing within a metre.
std::optional<Eigen::Vector3d> OnlinePlanner::flyableNear(const Eigen::Vector3d& p_w) const {
    constexpr double kRing = 0.05, kFarthest = 1.;  // [m]
    constexpr int kDirections = 16;
    const Eigen::AlignedBox3d& bounds = config_.bounds;
    const Eigen::Vector3d inside = p_w.cwiseMax(bounds.min()).cwiseMin(bounds.max());
    if (problem_.isFlyable(inside)) return inside;
    for (double radius = kRing; radius <= kFarthest; radius += kRing) {
        for (const double rise : {0., 0.5, -0.5}) {
            for (int i = 0; i < kDirections; ++i) {
                const double angle = 2. * std::numbers::pi * i / kDirections;
                const Eigen::Vector3d place =
                    inside + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), rise);
                if (bounds.contains(place) && problem_.isFlyable(place) && isWayOut(p_w, place)) {
                    return place;
                }
            }
        }
    }
    return {};
}

void OnlinePlanner::update(const MapChange& change, const UncertainPose& T_c_w, PlanUpdate& update,
                           const PlanningLimits& given) {
    const InterruptionScope scope = problem_.interruptedBy(given.interrupted);
    Stopwatch watch;
    {
        const std::lock_guard lock(worldMutex_);
        world_.mapChanged(change);
    }
    update.clearanceSeconds = watch.seconds();
    const auto field = planner_->model().sharedField();
    const InformationField& exact = problem_.evaluator().field();
    const std::size_t markedBefore = field->marked();
    const std::size_t viewsBefore = field->views() + exact.views();
    const double viewSecondsBefore = field->seconds() + exact.seconds();
    watch = {};
    problem_.followMap();

    const Limits limits(given);
    path_.clear();
    reachesGoal_ = false;
    const Pose T_w_b = T_c_w.mean.inverse() * config_.camera.T_b_c().inverse();
    if (const auto from_w = flyableNear(T_w_b.translation())) {
        ob::ScopedState<> state(problem_.spaceInformation());
        problem_.space().setState(state.get(), *from_w, yawOf(T_w_b));
        const Eigen::Matrix3d R_w_c = T_c_w.mean.linear().transpose();
        // Relative to the map in view. What the map's own error adds stays the same wherever the
        // way leads: texture seen for the first time does not inform of the place in the world.
        const Belief belief{inRotatedAxes(config_.belief.initialCovariance, R_w_c), 0.};
        update.counts = planFrom(state.get(), belief, limits);
        if (!plan_.empty()) evaluatePath(T_w_b, T_c_w.covariance);
    }
    update.planSeconds = watch.seconds();
    update.isEndedByClock = limits.isClockOver();
    update.viewSeconds = field->seconds() + exact.seconds() - viewSecondsBefore;
    update.viewsMarked = field->marked() - markedBefore;
    update.viewsRendered = field->views() + exact.views() - viewsBefore;
    update.cost = reachesGoal_ ? path_.back().cost : std::numeric_limits<double>::quiet_NaN();
    update.length = reachesGoal_ ? path_.back().length : std::numeric_limits<double>::quiet_NaN();
    update.trace = weightedTrace(T_c_w.covariance, config_.belief.characteristicLength);
}

/// @return what this changed in the tree
UpdateCounts OnlinePlanner::planFrom(const ob::State* state, const Belief& belief,
                                     const Limits& limits) {
    if (kind_.replanning == Replanning::never && hasPlanned_) {
        if (!plan_.empty()) plan_ = restOf(plan_, state);
        reachesGoal_ = !plan_.empty();
        return {};
    }
    const bool isNew = kind_.replanning == Replanning::scratch;
    if (isNew) planner_ = problem_.makePlanner(kind_.name, seed_);
    UpdateCounts dropped;
    const bool isFound = solveFrom(state, belief, limits);
    failed_ = isFound ? 0 : failed_ + 1;
    if (failed_ % kAnew == 1 && !isNew && !limits.isInterrupted()) {
        // What is left of a tree may be full without the goal: another one begins here.
        dropped = planner_->lastUpdate();
        dropped.verticesInvalidated += planner_->vertices();
        planner_ = problem_.makePlanner(kind_.name, ++seed_);
        solveFrom(state, belief, limits);
    }
    plan_ = solution(limits);
    reachesGoal_ = !plan_.empty();
    hasPlanned_ = hasPlanned_ || reachesGoal_;
    if (!reachesGoal_) plan_ = approach();
    UpdateCounts counts = planner_->lastUpdate();
    counts.verticesInvalidated += dropped.verticesInvalidated;
    counts.edgesInvalidated += dropped.edgesInvalidated;
    counts.verticesAdded += dropped.verticesAdded;
    return counts;
}

/// @return whether there is a way to the goal
bool OnlinePlanner::solveFrom(const ob::State* state, const Belief& belief, const Limits& limits) {
    planner_->moveRoot(state, belief);
    planner_->solve(ob::PlannerTerminationCondition(
        [&] { return limits.isOver(!planner_->bestPath().empty()); }));
    return planner_->getProblemDefinition()->hasExactSolution();
}

/// The planner's path, smoothed if it has seen no views, with the kind's headings; empty: there
/// is none.
OnlinePlanner::States OnlinePlanner::solution(const Limits& limits) const {
    const auto& best = planner_->bestPath();
    if (best.empty()) return {};
    const auto& si = problem_.spaceInformation();
    const auto withOurHeadings = [&](const auto& states) {
        States plan;
        for (const ob::State* state : states) plan.push_back(copyOf(si, state));
        return withHeadings(std::move(plan));
    };
    if (usesViews(kind_.name)) return withOurHeadings(best);
    const ob::PlannerTerminationCondition isOver([&] { return limits.isOver(true); });
    return withOurHeadings(
        shortenPath(si, problem_.space(), best, kChangesWithoutViews, isOver).getStates());
}

/// From the root to where the goal is near and the way there is not long, and a turn toward the
/// goal; empty: neither brings anything new.
OnlinePlanner::States OnlinePlanner::approach() const {
    States plan = wayNearGoal();
    if (plan.size() > 1) plan = withHeadings(std::move(plan));
    plan = facingGoal(std::move(plan));
    return plan.size() > 1 ? plan : States();
}

/// The way in the tree to the place nearest to the goal, where each metre of the way counts, too.
OnlinePlanner::States OnlinePlanner::wayNearGoal() const {
    constexpr double kNearer = 0.1;    // than the root, at least [m]
    constexpr double kPerMetre = 0.1;  // nearer by each metre of the way [m]
    const FlightSpace& space = problem_.space();
    const std::vector<TreeNode> tree = planner_->tree();
    if (tree.empty()) return {};
    const auto toGoal = [&](const ob::State* state) {
        return (config_.goal.position - space.position(state)).norm();
    };
    std::vector<double> length(tree.size(), 0.);
    std::size_t best = 0;
    double least = toGoal(tree[0].state) - kNearer;
    for (std::size_t i = 1; i < tree.size(); ++i) {
        if (tree[i].parent < 0) continue;
        const ob::State* parent = tree[tree[i].parent].state;
        length[i] = length[tree[i].parent] +
                    (space.position(parent) - space.position(tree[i].state)).norm();
        const double value = toGoal(tree[i].state) + kPerMetre * length[i];
        if (value >= least) continue;
        least = value;
        best = i;
    }
    States plan;
    for (int i = static_cast<int>(best); i >= 0; i = tree[i].parent) {
        plan.push_back(copyOf(problem_.spaceInformation(), tree[i].state));
    }
    std::reverse(plan.begin(), plan.end());
    return plan;
}

/// With a turn toward the goal at its end, where the robot may turn.
OnlinePlanner::States OnlinePlanner::facingGoal(States plan) const {
    constexpr double kTurned = 0.3;  // [rad]
    const bool canTurn = config_.space != StateKind::position && kind_.headings != Headings::fixed;
    if (plan.empty() || !canTurn) return plan;
    const FlightSpace& space = problem_.space();
    const ob::State* end = plan.back().get();
    const Eigen::Vector3d toGoal = config_.goal.position - space.position(end);
    const double facing = std::atan2(toGoal.y(), toGoal.x());
    const double turn = std::remainder(facing - yawOf(space.bodyPose(end)), 2. * std::numbers::pi);
    if (std::abs(turn) <= kTurned) return plan;
    plan.push_back(copyOf(problem_.spaceInformation(), end));
    space.setState(plan.back().get(), space.position(end), facing);
    return plan;
}

OnlinePlanner::States OnlinePlanner::withHeadings(States plan) const {
    if (!kind_.headings || plan.empty()) return plan;
    std::vector<const ob::State*> states;
    for (const auto& state : plan) states.push_back(state.get());
    return replaceHeadings(problem_.spaceInformation(), problem_.space(), states, *kind_.headings);
}

/// What is left of a plan for a robot that flies along it; empty: an obstacle was seen on it.
OnlinePlanner::States OnlinePlanner::restOf(const States& plan, const ob::State* state) const {
    const auto& si = problem_.spaceInformation();
    const auto place = [&](std::size_t i) { return problem_.space().position(plan[i].get()); };
    const Eigen::Vector3d here = problem_.space().position(state);
    std::size_t next = plan.size() - 1;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < plan.size(); ++i) {
        const double away = distanceToSegment(here, place(i - 1), place(i));
        if (away < nearest) next = i;
        nearest = std::min(nearest, away);
    }
    States rest{copyOf(si, state)};
    rest.insert(rest.end(), plan.begin() + static_cast<std::ptrdiff_t>(next), plan.end());
    for (std::size_t i = 1; i < rest.size(); ++i) {
        if (!si->checkMotion(rest[i - 1].get(), rest[i].get())) return {};
    }
    return rest;
}

/// The plan, begun with a covariance at the robot's pose.
std::vector<BeliefPoint> OnlinePlanner::pathFrom(const Pose& T_w_b, const Matrix6& covariance) {
    BeliefPoint here{.T_w_b = T_w_b, .covariance = covariance, .isWaypoint = true};
    here.traceBefore = here.trace = weightedTrace(covariance, config_.belief.characteristicLength);
    std::vector<BeliefPoint> path(2, here);
    path.back().T_w_b = problem_.space().bodyPose(plan_.front().get());
    path.back().length = path.back().distance =
        (path.back().T_w_b.translation() - T_w_b.translation()).norm();
    for (std::size_t i = 1; i < plan_.size(); ++i) {
        problem_.evaluator().evaluateMotion(plan_[i - 1].get(), plan_[i].get(), path);
    }
    return path;
}

/// Beliefs along the plan. A view of the map that the robot made itself is not counted as making
/// its pose better than it is now. The cost is that by which the planner chose: relative to the
/// map.
void OnlinePlanner::evaluatePath(const Pose& T_w_b, const Matrix6& covariance) {
    path_ = pathFrom(T_w_b, covariance);
    const std::vector<BeliefPoint> inMap = pathFrom(T_w_b, config_.belief.initialCovariance);
    const Matrix6 tiny = 1e-12 * Matrix6::Identity();
    for (std::size_t i = 0; i < path_.size(); ++i) {
        BeliefPoint& point = path_[i];
        point.cost = inMap[i].cost;
        point.covariance = larger(point.covariance + tiny, covariance);
        point.trace = weightedTrace(point.covariance, config_.belief.characteristicLength);
        point.traceBefore = std::max(point.traceBefore, point.trace);
    }
}

}  // namespace photonav
