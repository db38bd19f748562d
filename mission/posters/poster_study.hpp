// SPDX-License-Identifier: BSD-3-Clause
// A study of which posters improve localisation along a path, or servoing at a goal, most.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/localisation_check.hpp"
#include "posters/poster.hpp"
#include "problem/world.hpp"
#include "servo/servo_study.hpp"

namespace photonav {

/// The criterion of a ranking: localisation along the path, or servoing at the goal.
enum class RankBy { path, goal };

struct PosterStudyOptions {
    std::optional<GivenTrajectory> trajectory = {};  ///< none: a path is planned for every set
    bool hasPath = true;  ///< false: only servoing at the goal is studied
    RankBy rankBy = RankBy::path;
    std::size_t most = 1;  ///< most posters in a set; beyond one, posters are added greedily
    ServoStudyOptions servo = {};
    unsigned jobs = 1;  ///< threads
};

/// A scene and the posters that could be added to it.
struct PosterProblem {
    Config config;
    Scene scene = {};
    Pose T_w_goal = Pose::Identity();  ///< goal pose of the body, for servoing
    std::vector<Poster> posters = {};
    std::string file;  ///< file of the posters, named in messages
    PosterStudyOptions options = {};
};

/// Indices into PosterProblem::posters.
using PosterIndices = std::vector<std::size_t>;

/// A set of posters and the results in the scene with these posters.
struct PosterSet {
    PosterIndices posters;            ///< empty: the scene without posters
    GivenTrajectory trajectory = {};  ///< the trajectory that was checked
    /// Localisation along the trajectory; none: the planner found no path, or
    /// PosterStudyOptions::hasPath is false.
    std::optional<CheckedTrajectory> path = {};
    /// Cost of a planned path: alpha length + (1 - alpha) kappa integral of the trace; 0 for a
    /// given trajectory.
    double cost = 0.;
    ServoStudy servo = {};
    /// View of the config's camera at the goal. Shared, because sets are moved when they are
    /// sorted, and a vpImage that is assigned to after it was moved from never frees its memory.
    std::shared_ptr<const View> goalView = {};
};

struct PosterRanking {
    std::vector<PosterSet> sets;  ///< best set first
    bool interrupted = false;     ///< unfinished sets are then left out
};

/// The names of the posters in a set, "carpet + poster", or kNoPoster for an empty set.
std::string nameOf(const PosterIndices& set, const std::vector<Poster>& posters);

/// The scene with a set of posters.
World worldWith(const PosterProblem& problem, const PosterIndices& set);

/// @throws InputError with the key: for a start or goal in collision, for a poster that puts
///         the given trajectory in collision, and for a poster that coincides with a surface of the
///         scene (the renderer could not decide which of the two is in front)
void checkPosters(const PosterProblem& problem);

/// The key by which sets are sorted, in lexicographic order, smallest first. For RankBy::path:
/// length of the path on which the camera is lost [m], cost, mean trace [m^2] (a single infinite
/// entry without a path), then the entries for the goal. For RankBy::goal: number of open
/// directions, share of starts that do not converge, standard deviation of the position [m], then
/// the entries for the path. Entries are rounded to four digits, so that numerical differences do
/// not decide.
std::vector<double> rankKey(const PosterSet& set, RankBy by);

/// Whether paths are planned, so that kappa matters.
bool plansPaths(const PosterProblem& problem);

/// Studies the scene without posters and with every single poster. Then, up to options.most
/// posters, it adds each remaining poster to the best set so far, as long as the best set improves.
/// Posters with coincident surfaces are not combined. All paths are planned with the same seed and
/// with the kappa of the scene without posters. The path of the smaller set is kept if it is free
/// of collisions and better than the new one.
/// @param onBegin called before a set is studied, with the number of sets that are done and the
///        posters of this set; never called twice at a time
/// @throws Interrupted when interrupted before the first set is done
PosterRanking rankPosters(const PosterProblem& problem, const std::atomic<bool>& interrupted,
                          const std::function<void(std::size_t, const PosterIndices&)>& onBegin);

}  // namespace photonav
