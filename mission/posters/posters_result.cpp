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

std::string verdictOf(const PosterProblem& problem, const PosterRanking& ranking) {
    const PosterSet& best = ranking.sets.front();
    if (best.posters.empty()) return "no candidate improves on the scene as it is";
    const auto asItIs = std::ranges::find_if(
        ranking.sets, [](const PosterSet& set) { return set.posters.empty(); });
    std::string text =
        fmt::format("'{}' is the best by the {}", nameOf(best.posters, problem.posters),
                    problem.options.rankBy == RankBy::path ? "path" : "goal");
    if (asItIs == ranking.sets.end()) return text;
    if (best.path && asItIs->path) {
        text += fmt::format("; mean trace along the path {:.3g} m², without it {:.3g} m²",
                            best.path->meanTrace, asItIs->path->meanTrace);
        if (best.cost > 0.) text += fmt::format(" (cost {:.4g}, {:.4g})", best.cost, asItIs->cost);
    }
    return text + fmt::format("; at the goal {} of {} starts converge, without it {}",
                              best.servo.converged(), best.servo.trials(),
                              asItIs->servo.converged());
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
