// SPDX-License-Identifier: BSD-3-Clause
// Options of mapping a recording or laser scans.
#pragma once

#include <optional>
#include <string>

#include "map/map_fusion.hpp"
#include "recording/recording.hpp"

namespace photonav {

/// Options of a map of a recording.
struct MapOptions : RecordingOptions {
    double resolution = 0.05;  ///< edge of a cell [m]
    FusionOptions fusion;
    std::string depth = "recorded";  ///< "recorded", or "monocular": depth is estimated from the
                                     ///< images of one camera and their poses
    bool exposure = true;            ///< estimate the gain of every image, as ExposedFusion does
    /// Unknown cells in the views by which the map is evaluated.
    UnknownPolicy unknownToCamera = UnknownPolicy::free;
};

/// Default of FusionOptions::minRange [m].
/// @param depth MapOptions::depth
double defaultMinRange(const std::string& depth);

/// Options of a map of laser scans.
struct ScanMapOptions {
    std::string scans;         ///< a PLY file, or a folder with one PLY file per scanner station
    double resolution = 0.05;  ///< edge of a cell [m]
    double maxRange = 40.;     ///< points farther from the scanner are not mapped [m]
    /// Position of the scanner, for a single file that does not contain it [m].
    std::optional<Eigen::Vector3d> scanner;
};

}  // namespace photonav
