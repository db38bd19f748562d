// SPDX-License-Identifier: BSD-3-Clause
// result.json of a ranking of posters.
#pragma once

#include <nlohmann/json.hpp>

#include "posters/poster_study.hpp"

namespace photonav {

/// Which set is the best, and what it gains, in a sentence without its end.
std::string verdictOf(const PosterProblem& problem, const PosterRanking& ranking);

/// Everything of result.json but the time.
nlohmann::json postersResult(const PosterProblem& problem, const PosterRanking& ranking);

}  // namespace photonav
