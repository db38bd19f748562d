// SPDX-License-Identifier: BSD-3-Clause
// result.json of a ranking of posters.
#pragma once

#include <nlohmann/json.hpp>

#include "posters/poster_study.hpp"

namespace photonav {

/// Everything of result.json but the time.
nlohmann::json postersResult(const PosterProblem& problem, const PosterRanking& ranking);

}  // namespace photonav
