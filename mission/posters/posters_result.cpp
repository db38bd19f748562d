// SPDX-License-Identifier: BSD-3-Clause
#include "posters/posters_result.hpp"

#include "alignment/image_pyramid.hpp"
#include "check/check_result.hpp"
#include "result/json_values.hpp"
#include "servo/servo_result.hpp"

namespace photonav {
using nlohmann::json;

json postersResult(const PosterProblem& problem, const PosterRanking& ranking) {
    const PosterStudyOptions& options = problem.options;
    json sets = json::array();
    for (const PosterSet& set : ranking.sets) {
        json names = json::array();
        for (const std::size_t i : set.posters) names.push_back(problem.posters[i].name);
        sets.push_back({{"posters", names},
                        {"path", set.path ? localisationJson(*set.path) : json(nullptr)},
                        {"cost", set.cost > 0. ? json(set.cost) : json(nullptr)},
                        {"servo", servoStudyJson(set.servo)}});
    }
    return resultJson(
        "posters",
        {{"interrupted", ranking.interrupted},
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
