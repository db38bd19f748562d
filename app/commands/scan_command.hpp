// SPDX-License-Identifier: BSD-3-Clause
// `photonav map` of laser scans: coloured point clouds become a textured OctoMap.
#pragma once

#include "commands/map_command.hpp"

namespace photonav {

struct ScanMapOptions {
    std::string scans;          ///< a PLY file, or a folder with one per station of the scanner
    std::filesystem::path out;  ///< folder for the results; made when missing
    double resolution = 0.05;   ///< edge of a cell [m]
    double maxRange = 40.;      ///< farther points are not entered [m]
    std::optional<Eigen::Vector3d> scanner;  ///< of a single file without its position [m]
    std::string commandLine;                 ///< for the report

    /// Called after each station with the number done and the number there are.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Whether this is a PLY file or a folder with some (and not a recorded sequence).
bool isScan(const std::string& path);

/// Maps the scans and writes into options.out: map.ot, map_color.ot, map.bt, config.yaml,
/// result.json, overview.png and report.html. Memory does not depend on the number of points.
/// @param interrupted checked between stations; what is there then is written
/// @throws InputError for a file that is no coloured point cloud, a cloud too large for the cells,
///         and a folder that cannot be written
MapReport runScanMap(const ScanMapOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
