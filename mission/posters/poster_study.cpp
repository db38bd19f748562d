// SPDX-License-Identifier: BSD-3-Clause
#include "posters/poster_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "alignment/image_pyramid.hpp"
#include "check/obstruction.hpp"
#include "geometry/constants.hpp"
#include "io/error.hpp"
#include "planners/planner_table.hpp"
#include "problem/planning_problem.hpp"
#include "render/interruptible_views.hpp"
#include "runs/work_items.hpp"
#include "scene/coincident_surfaces.hpp"

namespace photonav {
namespace {

using OnBegin = std::function<void(std::size_t, const PosterIndices&)>;

/// Nothing where no path is found.
std::optional<GivenTrajectory> plannedIn(const World& world, const Config& config,
                                         const std::atomic<bool>& interrupted) {
    PlanningProblem planning(config, world, alphaOf(config.planner, config.belief.alpha));
    const PlanOutcome outcome = planning.solve(config.planner, interrupted);
    if (!outcome.isSolved()) return {};
    GivenTrajectory trajectory{TrajectoryFormat::table, true, {}};
    for (const BeliefPoint& point : outcome.path->points) {
        trajectory.poses.push_back({{}, point.T_w_b});
    }
    return trajectory;
}

/// The paths that a set may be judged by: a given one, or a new one, or that of the set that it
/// grew from.
std::vector<GivenTrajectory> trajectoriesIn(const World& world, const PosterProblem& problem,
                                            const PosterSet* before,
                                            const std::atomic<bool>& interrupted) {
    if (problem.options.trajectory) return {*problem.options.trajectory};
    std::vector<GivenTrajectory> trajectories;
    const auto planned = plannedIn(world, problem.config, interrupted);
    if (planned) trajectories.push_back(*planned);
    const bool isFree = before != nullptr && before->path &&
                        obstructionOf(before->trajectory, problem.config, world).collisions.empty();
    if (isFree) trajectories.push_back(before->trajectory);
    return trajectories;
}

double costOf(const CheckedTrajectory& path, const Config& config) {
    const double alpha = alphaOf(config.planner, config.belief.alpha);
    return path.places.back().distance *
           (alpha + (1. - alpha) * config.belief.kappa * path.meanTrace);
}

/// Keeps the trajectory on which the camera is lost least, the cheapest one of these.
void studyPath(const World& world, const PosterProblem& problem, const PosterSet* before,
               const std::atomic<bool>& interrupted, PosterSet& set) {
    for (const GivenTrajectory& trajectory : trajectoriesIn(world, problem, before, interrupted)) {
        CheckedTrajectory path =
            checkLocalisation(trajectory, problem.config, world, {.headings = 0}, interrupted);
        const double cost = problem.options.trajectory ? 0. : costOf(path, problem.config);
        const auto key = std::pair(path.lostLength(), cost);
        if (set.path && !(key < std::pair(set.path->lostLength(), set.cost))) continue;
        set.trajectory = trajectory;
        set.path = std::move(path);
        set.cost = cost;
    }
}

/// @param before the set that it grew from; null: none
/// @returns nothing when it was interrupted
std::optional<PosterSet> studySet(const PosterProblem& problem, const PosterIndices& posters,
                                  const PosterSet* before, const std::atomic<bool>& interrupted) {
    const World world = worldWith(problem, posters);
    const Config& config = problem.config;
    const Camera camera = config.camera.camera();
    PosterSet set{.posters = posters};
    try {
        if (problem.options.hasPath) studyPath(world, problem, before, interrupted, set);
        const InterruptibleViews views(world.sharedViews(), [&] { return interrupted.load(); });
        const ServoGoal goal{views, halved(camera), config.camera.T_b_c(), problem.T_w_goal,
                             config.photometric};
        set.servo = studyServo(goal, problem.options.servo, interrupted, [](double) {});
    } catch (const Interrupted&) {
    }
    if (interrupted) return {};
    const auto view = std::make_shared<View>();
    world.views().render(camera, (problem.T_w_goal * config.camera.T_b_c()).inverse(), *view);
    set.goalView = view;
    return set;
}

/// Studies lists of sets on several threads.
class SetStudies {
  public:
    SetStudies(const PosterProblem& problem, const std::atomic<bool>& interrupted,
               const OnBegin& onBegin)
        : problem_(problem), interrupted_(interrupted), onBegin_(onBegin) {}

    /// Those that were finished, in their order.
    std::vector<PosterSet> of(const std::vector<PosterIndices>& wanted, const PosterSet* before) {
        std::vector<std::optional<PosterSet>> studied(wanted.size());
        workInOrder(wanted.size(), problem_.options.jobs, [&](std::size_t i) {
            begin(wanted[i]);
            studied[i] = studySet(problem_, wanted[i], before, interrupted_);
            ++done_;
            return !interrupted_;
        });
        std::vector<PosterSet> sets;
        for (auto& set : studied) {
            if (set) sets.push_back(std::move(*set));
        }
        return sets;
    }

  private:
    void begin(const PosterIndices& set) {
        const std::lock_guard lock(mutex_);
        onBegin_(done_, set);
    }

    const PosterProblem& problem_;
    const std::atomic<bool>& interrupted_;
    const OnBegin& onBegin_;
    std::mutex mutex_;
    std::atomic<std::size_t> done_ = 0;
};

/// A set with each of the other posters that lie in none of its own.
std::vector<PosterIndices> grown(const PosterIndices& set, const std::vector<Poster>& posters) {
    std::vector<PosterIndices> larger;
    for (std::size_t i = 0; i < posters.size(); ++i) {
        const bool fits = std::ranges::none_of(set, [&](std::size_t member) {
            return member == i ||
                   haveCoincidentSurfaces(posters[member].surfaces, posters[i].surfaces);
        });
        if (!fits) continue;
        larger.push_back(set);
        larger.back().push_back(i);
    }
    return larger;
}

void checkPoster(const PosterProblem& problem, std::size_t i, const World& before) {
    const Poster& poster = problem.posters[i];
    const Config& config = problem.config;
    const auto refuse = [&](const std::string& what) {
        throw InputError(problem.file, keyOf(i), fmt::format("'{}' {}", poster.name, what));
    };
    if (haveCoincidentSurfaces(withoutSolids(poster.surfaces), problem.scene)) {
        refuse("lies in a surface of the scene; put it a centimetre in front");
    }
    const World world = worldWith(problem, {i});
    const auto checkPlace = [&](const char* name, const Eigen::Vector3d& p_w) {
        const double clearance = world.clearance(p_w);
        if (clearance > config.robotRadius || before.clearance(p_w) <= config.robotRadius) return;
        refuse(fmt::format("puts the {} in collision: clearance {:.3f} m, robot.radius {} m", name,
                           clearance, config.robotRadius));
    };
    checkPlace("goal", problem.T_w_goal.translation());
    if (!problem.options.hasPath) return;
    if (!problem.options.trajectory) {
        checkPlace("start", config.start.position);
        checkPlace("goal", config.goal.position);
        return;
    }
    const auto clearanceIn = [&](const World& w) {
        return obstructionOf(*problem.options.trajectory, config, w).leastClearance;
    };
    const double clearance = clearanceIn(world);
    if (clearance > config.robotRadius || clearance >= clearanceIn(before)) return;
    refuse(fmt::format("puts the trajectory in collision: clearance {:.3f} m, robot.radius {} m",
                       clearance, config.robotRadius));
}

/// To four digits.
double rounded(double value) {
    if (std::isnan(value)) return kInfinity;
    if (value == 0. || std::isinf(value)) return value;
    const double unit = std::pow(10., std::floor(std::log10(std::abs(value))) - 3.);
    return std::round(value / unit) * unit;
}

}  // namespace

std::string nameOf(const PosterIndices& set, const std::vector<Poster>& posters) {
    std::string name;
    for (const std::size_t i : set) name += (name.empty() ? "" : " + ") + posters[i].name;
    return name.empty() ? kNoPoster : name;
}

World worldWith(const PosterProblem& problem, const PosterIndices& set) {
    Scene scene = problem.scene;
    for (const std::size_t i : set) scene.append(problem.posters[i].surfaces);
    return {std::move(scene), problem.config};
}

void checkPosters(const PosterProblem& problem) {
    const World before = worldWith(problem, {});
    if (problem.options.hasPath && !problem.options.trajectory) {
        PlanningProblem(problem.config, before).checkPlaces();
    }
    for (std::size_t i = 0; i < problem.posters.size(); ++i) checkPoster(problem, i, before);
}

std::vector<double> rankKey(const PosterSet& set, RankBy by) {
    const ServoStudy& servo = set.servo;
    const double trials = std::max(1, servo.trials());
    std::vector<double> path{kInfinity};
    if (set.path) path = {set.path->lostLength(), set.cost, set.path->meanTrace};
    const std::vector<double> goal{static_cast<double>(servo.openDirections()),
                                   1. - servo.converged() / trials, servo.positionSigma};
    std::vector<double> key = by == RankBy::path ? path : goal;
    const std::vector<double>& rest = by == RankBy::path ? goal : path;
    key.insert(key.end(), rest.begin(), rest.end());
    std::ranges::transform(key, key.begin(), rounded);
    return key;
}

bool plansPaths(const PosterProblem& problem) {
    return problem.options.hasPath && !problem.options.trajectory;
}

PosterRanking rankPosters(const PosterProblem& given, const std::atomic<bool>& interrupted,
                          const std::function<void(std::size_t, const PosterIndices&)>& onBegin) {
    PosterProblem problem = given;
    const PosterStudyOptions& options = given.options;
    if (plansPaths(given)) {
        problem.config = withKappa(given.config, worldWith(given, {}), interrupted);
    }
    const auto isBefore = [&](const PosterSet& a, const PosterSet& b) {
        return rankKey(a, options.rankBy) < rankKey(b, options.rankBy);
    };
    SetStudies studies(problem, interrupted, onBegin);
    PosterRanking ranking;
    std::vector<PosterIndices> next{{}};
    for (std::size_t size = 0; !next.empty(); ++size) {
        const std::optional<PosterSet> before =
            size > 0 ? std::optional(ranking.sets.front()) : std::nullopt;
        for (PosterSet& set : studies.of(next, before ? &*before : nullptr)) {
            ranking.sets.push_back(std::move(set));
        }
        if (ranking.sets.empty()) throw Interrupted();
        std::ranges::stable_sort(ranking.sets, isBefore);
        const PosterIndices& best = ranking.sets.front().posters;
        const bool goesOn = !interrupted && size < options.most && best.size() == size;
        next = goesOn ? grown(best, given.posters) : std::vector<PosterIndices>();
    }
    ranking.interrupted = interrupted;
    return ranking;
}

}  // namespace photonav
