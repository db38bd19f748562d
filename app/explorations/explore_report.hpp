// SPDX-License-Identifier: BSD-3-Clause
// Result and report of `photonav explore`.
#pragma once

#include "exploration/explorations.hpp"
#include "flightlog/flight_log.hpp"
#include "report/report.hpp"

namespace photonav {

/// The flights of an exploration, of one run or merged from shards.
struct ExploreOutcome {
    std::string name;  ///< of the config
    std::string commandLine;
    std::vector<ExplorationResult> flights;  ///< in the order of trialItems(); the first with a map
    std::vector<ExplorationSummary> summaries;  ///< one per planner
    std::size_t ended = 0;                      ///< without a first one that was interrupted
    std::size_t asked = 0;                      ///< flights there should be
    bool interrupted = false;
    std::optional<FlightLog> log;  ///< of the first flight
};

/// The content of result.json: the first flight, all trials, and a summary per planner.
nlohmann::json exploreResult(const ExplorationSetup& setup, const ExploreOutcome& outcome);

/// Writes the map, the trajectories of the first flight, figures and the page.
/// @param world the true one
void writeExploreReport(const std::filesystem::path& folder, const ExplorationSetup& setup,
                        const World& world, const ExploreOutcome& outcome,
                        const nlohmann::json& result);

/// The page of a flight that has yet to begin: it listens to the events "moment" (momentJson()) and
/// "end" (endJson()) at the address `events` beside it.
/// @param log without moments; @param world the true one
std::string livePage(const ExplorationSetup& setup, const World& world, const std::string& name,
                     const std::string& commandLine, const FlightLog& log);

}  // namespace photonav
