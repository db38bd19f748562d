// SPDX-License-Identifier: BSD-3-Clause
// What becomes a map, and how: a recording, or laser scans.
#pragma once

#include <optional>
#include <string>

#include "map/map_fusion.hpp"
#include "recording/recording.hpp"

namespace photonav {

struct MapOptions : RecordingOptions {
    double resolution = 0.05;  ///< edge of a cell [m]
    FusionOptions fusion;
    std::string depth = "recorded";  ///< or "monocular": from the images, with their poses
    UnknownPolicy unknownToCamera =
        UnknownPolicy::free;  ///< in the views that the map is judged by
};

/// Nearest depth entered when nothing else is asked for [m].
double defaultMinRange(const std::string& depth);

struct ScanMapOptions {
    std::string scans;         ///< a PLY file, or a folder with one per station of the scanner
    double resolution = 0.05;  ///< edge of a cell [m]
    double maxRange = 40.;     ///< farther points are not entered [m]
    std::optional<Eigen::Vector3d> scanner;  ///< of a single file without its position [m]
};

}  // namespace photonav
