// SPDX-License-Identifier: BSD-3-Clause
// result.json of a ranking of posters.
#pragma once

#include <nlohmann/json.hpp>

#include "posters/poster_study.hpp"

namespace photonav {

/// The best set and its improvement over the scene without posters, in a sentence without full
/// stop.
std::string verdictOf(const PosterProblem& problem, const PosterRanking& ranking);

/// The content of result.json without the computation time.
nlohmann::json postersResult(const PosterProblem& problem, const PosterRanking& ranking);

}  // namespace photonav
