// SPDX-License-Identifier: BSD-3-Clause
// Stores the first flight of an exploration keyframe by keyframe, for the case that the program is
// killed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "flightlog/flight_log.hpp"
#include "io/stopwatch.hpp"
#include "runs/journal_file.hpp"

namespace photonav {

/// The part of a command's time that something repeated may take. What takes long is done less
/// often.
class LimitedShare {
  public:
    explicit LimitedShare(double share) : share_(share) {}
    /// Calls `work`, unless too little time has passed since the last call.
    void call(const std::function<void()>& work);

  private:
    double share_, took_ = 0.;  // took_: the last call [s]
    Stopwatch since_;
};

/// The flight so far in a folder: with every update of the plan a line of kWords.file (moment of
/// the log, with the planner's tree), the map and a page that shows the flight. Each is written as
/// a whole or not at all. The lines cost the same throughout the flight. Map and page grow with it:
/// they are written after every update only as long as that takes less than a tenth (map) and a
/// twentieth (page) of the time.
///
/// A flight is deterministic, so that a killed one is flown again from its start. Until it is where
/// it was, the folder stays as the killed program left it.
class FlightStore {
  public:
    static constexpr RunWords kWords{"explore", "flight.jsonl", "keyframe", "a flight",
                                     "the flight"};
    using Page = std::function<std::string(const FlightLog& soFar)>;

    /// Continues the file of a killed program if it is of the same flight, else begins a new one.
    /// @param header its name is that of the flight
    /// @param page makes the page of a flight that has not ended
    /// @throws InputError for a damaged file, and if it cannot be written
    FlightStore(std::filesystem::path folder, JournalHeader header, Page page);

    /// Stores an update of the plan. A flight that is no longer the stored one, as on another
    /// processor, replaces it. @param log with this moment as the last one
    void add(const ExplorationMoment& moment, const FlightLog& log);

    /// Number of updates that a killed program has stored.
    std::size_t earlier() const { return earlier_.size(); }

    /// Removes the file of lines: the flight has ended.
    void remove();

  private:
    bool isStored(const LoggedMoment& moment, std::size_t number);

    std::filesystem::path folder_;
    JournalHeader header_;
    Page page_;
    JournalFile file_;
    std::vector<nlohmann::json> earlier_;  // updates of the killed flight
    LimitedShare map_, shown_;
};

/// A killed flight.
struct StoredFlight {
    std::string name;           ///< nameOf(TrialItem)
    std::size_t keyframes = 0;  ///< number of its updates; 0: there is no flight
};

/// The killed flight that a folder holds. @throws InputError for a damaged file
StoredFlight storedFlight(const std::filesystem::path& folder);

}  // namespace photonav
