// SPDX-License-Identifier: BSD-3-Clause
// Laser scans become a textured OctoMap.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "map/point_cloud.hpp"
#include "map/textured_octree.hpp"
#include "mapping/map_options.hpp"

namespace photonav {

/// Whether this is a PLY file or a folder with some (and not a recorded sequence).
bool isScan(const std::string& path);

/// The scan of one station.
struct Scan {
    std::filesystem::path file;
    PointCloudFile cloud;
};

/// Reads the headers of all files.
/// @throws InputError for a file that is no coloured point cloud and an option out of range
std::vector<Scan> openScans(const ScanMapOptions& options);

struct FusedScan {
    std::filesystem::path file;
    std::uint64_t points = 0;  ///< in the file
    std::uint64_t used = 0;    ///< of these, finite
    std::optional<Eigen::Vector3d> scanner;
    double seconds = 0.;
};

/// Fuses all scans into an empty map of the resolution asked for. Memory does not depend on the
/// number of points.
/// @param isStopped asked before every scan
/// @param progress called after every scan with the number done and the number there are
/// @throws InputError for a point that cannot be read, and a cloud too large for the cells
std::vector<FusedScan> fuseScans(
    TexturedOcTree& map, const std::vector<Scan>& scans, const ScanMapOptions& options,
    const std::function<bool()>& isStopped = {},
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace photonav
