// SPDX-License-Identifier: BSD-3-Clause
// The report of a ranking of posters.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "posters/poster_study.hpp"

namespace photonav {

/// The ranking as a table for a terminal. Lines have at most 80 columns if no word of a name has
/// more than 16 characters.
std::string rankingText(const PosterProblem& problem, const PosterRanking& ranking);

/// Writes all files of the result folder except result.json.
/// @param result content of result.json
void writePostersReport(const std::filesystem::path& folder, const PosterProblem& problem,
                        const PosterRanking& ranking, const std::string& commandLine,
                        const nlohmann::json& result);

}  // namespace photonav
