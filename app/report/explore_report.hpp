// SPDX-License-Identifier: BSD-3-Clause
// Result and report of `photonav explore`.
#pragma once

#include "exploration/explorations.hpp"
#include "report/report.hpp"

namespace photonav {

/// One per planner, in the order of the flights.
std::vector<ExplorationSummary> summariesOf(const ExplorationSetup& setup,
                                            const std::vector<ExplorationResult>& flights);

/// The content of result.json: the first flight, all trials, and a summary per planner.
nlohmann::json exploreResult(const ExplorationSetup& setup,
                             const std::vector<ExplorationResult>& flights, bool interrupted);

/// Writes the map, the trajectories of the first flight, figures and the page.
/// @param world the true one
void writeExploreReport(const std::filesystem::path& folder, const ExplorationSetup& setup,
                        const World& world, const std::vector<ExplorationResult>& flights,
                        const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
