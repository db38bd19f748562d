// SPDX-License-Identifier: BSD-3-Clause
// `photonav map` for laser scans: makes a textured OctoMap from coloured point clouds.
#pragma once

#include "recordings/map_command.hpp"

namespace photonav {

struct ScanCommandOptions : ScanMapOptions {
    std::filesystem::path out;  ///< result folder; created if it does not exist
    std::string commandLine;    ///< the command as typed, for the report

    /// Called after each station with the number of stations done and their total number.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Makes a map from the scans and writes into options.out: map.ot, map_color.ot, map.bt,
/// config.yaml, result.json, overview.png, report.json and report.html. The memory needed does not
/// depend on the number of points.
/// @param interrupted when set, the map of the stations so far is written
/// @throws InputError for a file that is no coloured point cloud, for a cloud that is too large for
///         the size of the cells, and for a folder that cannot be written
CommandReport runScanMap(const ScanCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
