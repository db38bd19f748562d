// SPDX-License-Identifier: BSD-3-Clause
#include "flights/posters_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "flights/posters_report.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "plans/plan_progress.hpp"
#include "posters/posters_result.hpp"
#include "result/json_values.hpp"
#include "shared/place_option.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

PosterProblem problemOf(const PostersOptions& options) {
    PosterProblem problem{.config = loadConfig(options.config, options.overrides),
                          .file = options.candidates};
    const Config& config = problem.config;
    if (config.sceneFile.empty()) {
        throw config.invalid("map.file", "posters need a scene: give scene.file");
    }
    PosterStudyOptions& study = problem.options;
    study.servo = studyOf(options, config);
    study.hasPath = !options.goalOnly;
    study.rankBy = options.goalOnly || options.rankBy == "goal" ? RankBy::goal : RankBy::path;
    study.most = options.most;
    study.jobs = options.jobs;
    if (!options.trajectory.empty()) {
        study.trajectory = readGivenTrajectory(options.trajectory, config.camera.T_b_c());
    }
    problem.posters = readPosters(options.candidates);
    problem.scene = *World(config).scene();
    problem.T_w_goal = bodyAt(placeOf(options.at, config.goal, config));
    checkPosters(problem);
    return problem;
}

/// The number of sets studied if every poster added improves the best set.
std::size_t mostSets(const PosterProblem& problem) {
    std::size_t sets = 1;
    const std::size_t posters = problem.posters.size();
    for (std::size_t size = 0; size < std::min<std::size_t>(problem.options.most, posters); ++size)
        sets += posters - size;
    return sets;
}

bool isSolved(const PosterSet& best, const PosterStudyOptions& options) {
    return options.rankBy == RankBy::path ? best.path && !best.path->isLost()
                                          : best.servo.openDirections() == 0;
}

}  // namespace

int runPosters(const PostersOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    PosterProblem problem = problemOf(options);
    FolderTransaction folder = beginResult(
        options, "posters", inputsOf(problem.config, {options.candidates, options.trajectory}));
    ProgressLine line(options.quiet);
    if (plansPaths(problem)) {
        problem.config = withKappaSaid(problem.config, worldWith(problem, {}), line, interrupted);
    }
    const std::size_t most = mostSets(problem);
    const PosterRanking ranking =
        rankPosters(problem, interrupted, [&](std::size_t done, const PosterIndices& set) {
            line.show(fmt::format("{} of at most {} sets studied, now {}", done, most,
                                  nameOf(set, problem.posters)),
                      static_cast<double>(done) / static_cast<double>(most));
        });
    line.clear();
    nlohmann::json result = postersResult(problem, ranking);
    result["time"]["total_s"] = watch.seconds();
    writePostersReport(folder.path(), problem, ranking, options.commandLine, result);
    concludeResult(folder, options, result,
                   [&] { fmt::print("{}", rankingText(problem, ranking)); });
    if (ranking.interrupted) return kInterrupted;
    return isSolved(ranking.sets.front(), problem.options) ? kDone : kNoAnswer;
}

}  // namespace photonav
