// SPDX-License-Identifier: BSD-3-Clause
#include "posters/posters_result.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "alignment/image_pyramid.hpp"
#include "check/check_result.hpp"
#include "result/json_values.hpp"
#include "servo/servo_result.hpp"

namespace photonav {
using nlohmann::json;
namespace {

/// What a set of posters changes of the path, compared with the scene as it is.
std::string pathGain(const PosterSet& best, const PosterSet& asItIs) {
    if (!best.path || !asItIs.path) return "";
    const std::string text =
        fmt::format(": mean trace along the path {:.3g} m² instead of {:.3g} m²",
                    best.path->meanTrace, asItIs.path->meanTrace);
    if (!(best.cost > 0.)) return text;
    return text + fmt::format(", cost {:.4g} instead of {:.4g}", best.cost, asItIs.cost);
}

/// What it changes of servoing at the goal.
std::string goalGain(const PosterSet& best, const PosterSet& asItIs) {
    return fmt::format(": {} of {} starts converge instead of {}", best.servo.converged(),
                       best.servo.trials(), asItIs.servo.converged());
}

}  // namespace

std::string verdictOf(const PosterProblem& problem, const PosterRanking& ranking) {
    const PosterSet& best = ranking.sets.front();
    if (best.posters.empty()) return "no candidate improves on the scene as it is";
    const auto asItIs = std::ranges::find_if(
        ranking.sets, [](const PosterSet& set) { return set.posters.empty(); });
    const bool isByPath = problem.options.rankBy == RankBy::path;
    const std::string text =
        fmt::format("'{}' is the best for {}", nameOf(best.posters, problem.posters),
                    isByPath ? "the path" : "servoing at the goal");
    if (asItIs == ranking.sets.end()) return text;
    return text + (isByPath ? pathGain(best, *asItIs) : goalGain(best, *asItIs));
}

json postersResult(const PosterProblem& problem, const PosterRanking& ranking) {
    const PosterStudyOptions& options = problem.options;
    json sets = json::array();
    for (const PosterSet& set : ranking.sets) {
        json names = json::array();
        for (const std::size_t i : set.posters) names.push_back(problem.posters[i].name);
        sets.push_back({{"name", nameOf(set.posters, problem.posters)},
                        {"posters", names},
                        {"path", set.path ? localisationJson(*set.path) : json(nullptr)},
                        {"cost", set.cost > 0. ? json(set.cost) : json(nullptr)},
                        {"servo", servoStudyJson(set.servo)}});
    }
    return resultJson(
        "posters",
        {{"interrupted", ranking.interrupted},
         {"verdict", verdictOf(problem, ranking)},
         {"candidates_file", problem.file},
         {"ranked_by", options.rankBy == RankBy::path ? "path" : "goal"},
         {"path_is", !options.hasPath     ? json(nullptr)
                     : options.trajectory ? json("given")
                                          : json("planned")},
         {"goal", vectorJson(problem.T_w_goal.translation())},
         {"servo", servoOptionsJson(options.servo, halved(problem.config.camera.camera()))},
         {"seed", problem.config.seed},
         {"characteristic_length", problem.config.belief.characteristicLength},
         {"ranking", sets}});
}

}  // namespace photonav
