// SPDX-License-Identifier: BSD-3-Clause
// Which of some posters make a path, or servoing at a goal, most certain.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "check/localisation_check.hpp"
#include "posters/poster.hpp"
#include "problem/world.hpp"
#include "servo/servo_study.hpp"

namespace photonav {

enum class RankBy { path, goal };

struct PosterStudyOptions {
    std::optional<GivenTrajectory> trajectory = {};  ///< none: planned with every set
    bool hasPath = true;                             ///< false: servoing at the goal alone
    RankBy rankBy = RankBy::path;
    std::size_t most = 1;  ///< posters of a set; beyond one they are added greedily
    ServoStudyOptions servo = {};
    unsigned jobs = 1;  ///< threads
};

/// A scene and what could be brought into it.
struct PosterProblem {
    Config config;
    Scene scene = {};
    Pose T_w_goal = Pose::Identity();  ///< of the body that servos
    std::vector<Poster> posters = {};
    std::string file;  ///< of the posters, for messages
    PosterStudyOptions options = {};
};

using PosterIndices = std::vector<std::size_t>;

/// What some posters together do.
struct PosterSet {
    PosterIndices posters;            ///< empty: the scene as it is
    GivenTrajectory trajectory = {};  ///< that was flown
    std::optional<CheckedTrajectory> path =
        {};            ///< none: the planner found none, or none was asked for
    double cost = 0.;  ///< of the path, if it was planned: alpha length +
                       ///< (1 - alpha) kappa integral of the trace
    ServoStudy servo = {};
    View goalView = {};  ///< of the config's camera
};

struct PosterRanking {
    std::vector<PosterSet> sets;  ///< the most certain first
    bool interrupted = false;     ///< sets that were not finished are left out
};

/// "carpet + poster", or kNoPoster.
std::string nameOf(const PosterIndices& set, const std::vector<Poster>& posters);

/// The scene with posters in it.
World worldWith(const PosterProblem& problem, const PosterIndices& set);

/// @throws InputError naming file and key: for a start or goal in collision, a trajectory in
///         collision with a poster, and a poster in a surface of the scene, where the renderer
///         would show now the one, now the other
void checkPosters(const PosterProblem& problem);

/// What ranks sets, the least first, entry by entry. By the path: the way on which the camera is
/// lost (infinite without a path), the cost, the mean trace; by the goal: the number of open
/// directions, the share of starts that do not converge, the standard deviation of the position.
/// The others follow. Four digits count: what differs less is rounding.
std::vector<double> rankKey(const PosterSet& set, RankBy by);

/// Studies the scene as it is, every poster alone, and then, up to options.most, the best set so
/// far with one more poster each, as long as that is better. Posters that lie in each other are not
/// combined. Paths are planned with one seed and one kappa, that of the scene as it is; where the
/// path of the set before is free and cheaper, that is taken.
/// @param onBegin called before a set is studied, with the number of sets that are done
/// @throws RenderingStopped when interrupted before the first set is done
PosterRanking rankPosters(const PosterProblem& problem, const std::atomic<bool>& interrupted,
                          const std::function<void(std::size_t, const PosterIndices&)>& onBegin);

}  // namespace photonav
