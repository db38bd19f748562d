// SPDX-License-Identifier: BSD-3-Clause
// Makes the log of a flight while it is flown.
#pragma once

#include "flightlog/drawn_cells.hpp"
#include "flightlog/flight_grids.hpp"

namespace photonav {

/// Makes the log of one flight. The size of the log is bounded: for a long flight, only every
/// second, fourth, ... moment keeps its pictures and tree, at most `mostPictures` moments.
class FlightLogger {
  public:
    static constexpr std::size_t kMostPictures = 160;

    /// @param config config of the flight
    /// @param world the true world, for its bounding box
    /// @param item the flight
    /// @param mostPictures largest number of moments with pictures
    FlightLogger(const Config& config, const World& world, const TrialItem& item,
                 std::size_t mostPictures = kMostPictures);

    /// Adds a moment of the flight.
    void add(const ExplorationMoment& moment);

    /// Adds the end of the flight, and the exposures since the last moment.
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
    std::size_t samples_ = 0;        // number of samples in the log
    std::size_t stride_ = 1;         // every stride_-th moment has pictures
    double lastFlown_ = -1.;         // time of the last exposure in the log [s]
    double lastInformation_ = -1e9;  // time of the last information grid [s]
};

}  // namespace photonav
