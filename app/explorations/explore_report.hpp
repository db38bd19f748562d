// SPDX-License-Identifier: BSD-3-Clause
// Result and report of `photonav explore`.
#pragma once

#include "exploration/explore_result.hpp"
#include "flightlog/flight_log.hpp"
#include "report/report.hpp"

namespace photonav {

struct ExploreOutcome : ExplorationSet {
    std::string name;  ///< of the config
    std::string commandLine;
    std::optional<FlightLog> log;  ///< of the first flight
};

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
