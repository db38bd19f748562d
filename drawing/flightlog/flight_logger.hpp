// SPDX-License-Identifier: BSD-3-Clause
// Writes down a flight while it is flown.
#pragma once

#include "flightlog/drawn_cells.hpp"
#include "flightlog/flight_grids.hpp"

namespace photonav {

/// Makes the log of one flight. Its size is bounded: of a long flight, pictures and trees of every
/// second, fourth, ... moment are kept, `mostPictures` at most.
class FlightLogger {
  public:
    static constexpr std::size_t kMostPictures = 160;

    /// @param config of the flight; @param world the true one, for the size of what can be seen
    FlightLogger(const Config& config, const World& world, const TrialItem& item,
                 std::size_t mostPictures = kMostPictures);

    /// Adds a moment of the flight.
    void add(const ExplorationMoment& moment);

    /// Adds how the flight ended, and what was flown since the last moment.
    void finish(const ExplorationResult& flight);

    const FlightLog& log() const { return log_; }

  private:
    std::vector<FlownPoint> flownSince(const std::vector<FlightSample>& samples, bool isEnd);
    MomentPictures picturesOf(const ExplorationMoment& moment);
    void thinOut();

    double characteristicLength_;
    std::size_t mostPictures_;
    Pose T_c_b_;
    FlightLog log_;
    DrawnCells cells_;
    SeenGround seen_;
    std::size_t samples_ = 0;        // taken into the log
    std::size_t stride_ = 1;         // moments from one with pictures to the next
    double lastFlown_ = -1.;         // [s]
    double lastInformation_ = -1e9;  // [s]
};

}  // namespace photonav
