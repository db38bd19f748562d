// SPDX-License-Identifier: BSD-3-Clause
// Result and report of `photonav explore`.
#pragma once

#include "exploration/explorations.hpp"
#include "report/report.hpp"

namespace photonav {

/// The content of result.json: the first flight, all trials, and a summary per planner.
/// @param summaries of the flights
nlohmann::json exploreResult(const ExplorationSetup& setup,
                             const std::vector<ExplorationResult>& flights,
                             const std::vector<ExplorationSummary>& summaries, bool interrupted);

/// Writes the map, the trajectories of the first flight, figures and the page.
/// @param world the true one
/// @param summaries of the flights
void writeExploreReport(const std::filesystem::path& folder, const ExplorationSetup& setup,
                        const World& world, const std::vector<ExplorationResult>& flights,
                        const std::vector<ExplorationSummary>& summaries,
                        const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
