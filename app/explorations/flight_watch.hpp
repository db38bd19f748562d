// SPDX-License-Identifier: BSD-3-Clause
// Logs the first flight of an exploration, and shows it to browsers while it is flown.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>

#include "exploration/explorations.hpp"
#include "explorations/flight_store.hpp"
#include "flightlog/flight_logger.hpp"
#include "live/live_server.hpp"

namespace photonav {

/// The log of a flight and, on request, a store and a server for browsers.
class FlightWatch {
  public:
    /// @param config config of the flight, see ExplorationSetup
    /// @param world the true world
    /// @param item the flight
    /// @param interrupted must outlive the watch. Once it is set, an update may have been cut
    /// short,
    ///        and is not stored.
    FlightWatch(const Config& config, const World& world, const TrialItem& item,
                const std::atomic<bool>& interrupted)
        : interrupted_(interrupted), logger_(config, world, item) {}

    /// Starts a server that shows the flight, and prints its address.
    /// @param page livePage() of log()
    /// @throws InputError as the constructor of LiveServer does
    void serve(const ServerAddress& address, std::string page);

    /// Also stores the flight while it is flown.
    /// @return number of updates of a killed flight that the store holds
    std::size_t storeIn(std::unique_ptr<FlightStore> store);

    /// A callback that adds a moment to the log, stores it and sends it to the browsers. It must
    /// not outlive the watch.
    OnExplorationMoment onMoment();

    /// Whether the store holds a killed flight that went on longer than this one so far.
    bool isBehindStored() const { return store_ && log().moments.size() < store_->earlier(); }
    /// The flight is kept elsewhere.
    void removeStored() {
        if (store_) store_->remove();
    }

    /// Adds the end of the flight, writes the log into a folder, and informs the browsers.
    void finish(const ExplorationResult& flight, const std::filesystem::path& folder);

    const FlightLog& log() const { return logger_.log(); }

  private:
    const std::atomic<bool>& interrupted_;
    FlightLogger logger_;
    std::unique_ptr<LiveServer> server_;
    std::unique_ptr<FlightStore> store_;
};

/// Reads the log of a flight from a folder; nothing if the folder has no log, or the log of another
/// flight.
/// @throws InputError for a damaged log
std::optional<FlightLog> readFlightLog(const std::filesystem::path& folder, const TrialItem& item);

/// Writes the log as FlightLog::kFileName.
/// @throws InputError if the file cannot be written
void writeFlightLog(const std::filesystem::path& folder, const FlightLog& log);

}  // namespace photonav
