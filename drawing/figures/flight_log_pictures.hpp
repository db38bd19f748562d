// SPDX-License-Identifier: BSD-3-Clause
// Decodes the images and grids of a flight log into colour pictures.
#pragma once

#include "flightlog/flight_log.hpp"
#include "plot/picture.hpp"

namespace photonav {

/// What is drawn at a moment: its own part, or the last one before it. Null: there is none.
/// @param part of MomentPictures
const std::string* latest(const FlightLog& log, std::size_t moment,
                          std::string MomentPictures::*part);

/// A grey image; empty where it cannot be decoded.
Picture greyPicture(const std::string& file);

/// Of MomentPictures::obstacles.
Picture obstaclePicture(const std::string& file);

/// The range of informationLevel() over some grids.
struct LevelRange {
    int least = kNoInformation, largest = 0;
    void add(const std::string& file);
    bool empty() const { return largest < least; }
    static double traceOf(int level);
};

/// Of MomentPictures::information, in viridis over a range.
Picture informationPicture(const std::string& file, const LevelRange& range);

}  // namespace photonav
