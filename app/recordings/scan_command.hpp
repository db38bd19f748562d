// SPDX-License-Identifier: BSD-3-Clause
// `photonav map` of laser scans: coloured point clouds become a textured OctoMap.
#pragma once

#include "recordings/map_command.hpp"

namespace photonav {

struct ScanCommandOptions : ScanMapOptions {
    std::filesystem::path out;  ///< folder for the results; made when missing
    std::string commandLine;    ///< for the report

    /// Called after each station with the number done and the number there are.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Maps the scans and writes into options.out: map.ot, map_color.ot, map.bt, config.yaml,
/// result.json, overview.png and report.html. Memory does not depend on the number of points.
/// @param interrupted checked between stations; what is there then is written
/// @throws InputError for a file that is no coloured point cloud, a cloud too large for the cells,
///         and a folder that cannot be written
MapReport runScanMap(const ScanCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
