// SPDX-License-Identifier: BSD-3-Clause
// Fuses laser scans into a textured OctoMap.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/interrupted.hpp"
#include "map/point_cloud.hpp"
#include "map/textured_octree.hpp"
#include "mapping/map_options.hpp"

namespace photonav {

/// Whether a path is a PLY file, or a folder that contains PLY files and is no recorded sequence.
bool isScan(const std::string& path);

/// The scan of one scanner station.
struct Scan {
    std::filesystem::path file;
    PointCloudFile cloud;
};

/// Reads the headers of all files.
/// @throws InputError for a file that is no coloured point cloud, and for an option out of range
std::vector<Scan> openScans(const ScanMapOptions& options);

struct FusedScan {
    std::filesystem::path file;
    std::uint64_t points = 0;                ///< number of points in the file
    std::uint64_t used = 0;                  ///< number of points with finite coordinates
    std::optional<Eigen::Vector3d> scanner;  ///< position of the scanner, if known [m]
    double seconds = 0.;                     ///< wall-clock time [s]
};

/// Fuses all scans into a map. Points are streamed: memory does not depend on their number.
/// @param map empty, with the resolution of the options
/// @param isStopped asked before every scan
/// @param progress called after every scan with the number of fused scans and of all scans
/// @throws InputError for a point that cannot be read, and for a cloud too large for the size of
///         the cells
std::vector<FusedScan> fuseScans(
    TexturedOcTree& map, const std::vector<Scan>& scans, const ScanMapOptions& options,
    const IsStopped& isStopped = {},
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace photonav
