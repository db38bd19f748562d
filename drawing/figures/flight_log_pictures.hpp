// SPDX-License-Identifier: BSD-3-Clause
// Decodes the images and grids of a flight log into colour pictures.
#pragma once

#include "flightlog/flight_log.hpp"
#include "plot/picture.hpp"

namespace photonav {

/// The picture to draw at a moment: the moment's own picture or, if it has none, the last one
/// before it; null if there is none. The pointer refers into the log.
/// @param moment index into FlightLog::moments
/// @param part which of the pictures
const std::string* latest(const FlightLog& log, std::size_t moment,
                          std::string MomentPictures::*part);

/// Decodes a grey image. The picture is empty if the file is damaged or a side exceeds 4096 pixels.
/// @param file content of a JPEG or PNG file
Picture greyPicture(const std::string& file);

/// Colours for the ObstacleLevel of each pixel; empty as for greyPicture().
/// @param file content of MomentPictures::obstacles
Picture obstaclePicture(const std::string& file);

/// The smallest and largest informationLevel() in several grids.
struct LevelRange {
    int least = kNoInformation, largest = 0;
    /// Extends the range by the levels of a grid.
    /// @param file content of MomentPictures::information
    void add(const std::string& file);
    bool empty() const { return largest < least; }
    /// The trace of the Fisher information for a level: the inverse of informationLevel().
    static double traceOf(int level);
};

/// A grid of information in the colours of viridis over a range; grey for kNoInformation. Empty as
/// for greyPicture().
/// @param file content of MomentPictures::information
Picture informationPicture(const std::string& file, const LevelRange& range);

}  // namespace photonav
