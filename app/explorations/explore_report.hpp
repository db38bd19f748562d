// SPDX-License-Identifier: BSD-3-Clause
// Report of `photonav explore`.
#pragma once

#include <functional>

#include "exploration/explore_result.hpp"
#include "flightlog/flight_log.hpp"
#include "report/report.hpp"

namespace photonav {

struct ExploreOutcome : ExplorationSet {
    std::string name;              ///< name of the config
    std::string commandLine;       ///< the command as typed
    std::optional<FlightLog> log;  ///< log of the first flight; none: it was not kept
};

/// Writes map.ot and the trajectory files of the first flight, figures, config.yaml, report.json
/// and report.html.
/// @param world the true world
/// @param result content of result.json
void writeExploreReport(const std::filesystem::path& folder, const ExplorationSetup& setup,
                        const World& world, const ExploreOutcome& outcome,
                        const nlohmann::json& result);

/// The HTML page that shows a flight while it is flown. The page receives the server-sent events
/// "moment" (momentJson()) and "end" (endJson()) from the relative address `events`.
/// @param world the true world
/// @param name name of the config
/// @param log log of the flight before its first moment
std::string livePage(const ExplorationSetup& setup, const World& world, const std::string& name,
                     const std::string& commandLine, const FlightLog& log);

/// Makes the HTML page of a flight that has not ended, with its log so far.
/// @param world the true world
/// @param name name of the config
std::function<std::string(const FlightLog& soFar)> pageSoFar(const ExplorationSetup& setup,
                                                             const World& world,
                                                             const std::string& name,
                                                             const std::string& commandLine);

}  // namespace photonav
