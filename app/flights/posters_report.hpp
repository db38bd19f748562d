// SPDX-License-Identifier: BSD-3-Clause
// The report of a ranking of posters.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "posters/poster_study.hpp"

namespace photonav {

/// The ranking as lines of at most 80 columns, if no word of a name is longer than 16.
std::string rankingText(const PosterProblem& problem, const PosterRanking& ranking);

/// Writes all files of the result folder but result.json.
void writePostersReport(const std::filesystem::path& folder, const PosterProblem& problem,
                        const PosterRanking& ranking, const std::string& commandLine,
                        const nlohmann::json& result);

}  // namespace photonav
