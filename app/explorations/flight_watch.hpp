// SPDX-License-Identifier: BSD-3-Clause
// The first flight of an exploration, written down as it is flown, and shown to browsers.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "exploration/explorations.hpp"
#include "flightlog/flight_logger.hpp"
#include "live/live_server.hpp"

namespace photonav {

class FlightWatch {
  public:
    /// @param config of the flight; @param world the true one
    FlightWatch(const Config& config, const World& world, const TrialItem& item)
        : logger_(config, world, item) {}

    /// Shows the flight from here on.
    /// @param page livePage() of log()
    /// @throws InputError as LiveServer
    void serve(const ServerAddress& address, std::string page);

    /// Must not outlive the watch.
    OnExplorationMoment onMoment();

    /// The flight has ended: writes its log into a folder.
    void finish(const ExplorationResult& flight, const std::filesystem::path& folder);

    const FlightLog& log() const { return logger_.log(); }

  private:
    FlightLogger logger_;
    std::unique_ptr<LiveServer> server_;
};

/// The log of a flight in a folder; none where there is none, or one of another flight.
/// @throws InputError for a damaged one
std::optional<FlightLog> readFlightLog(const std::filesystem::path& folder, const TrialItem& item);

void writeFlightLog(const std::filesystem::path& folder, const FlightLog& log);

}  // namespace photonav
