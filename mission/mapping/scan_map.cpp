// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/scan_map.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "map/map_fusion.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

// A scanner's echo is a surface, and a ray that grazes its cell on the way elsewhere is weak
// evidence of free space.
constexpr double kHit = 0.9, kMiss = 0.4;

std::set<fs::path> plyFiles(const fs::path& path) {
    if (!fs::is_directory(path)) return {path};
    std::set<fs::path> files;
    for (const auto& entry : fs::directory_iterator(path)) {
        if (entry.path().extension() == ".ply") files.insert(entry.path());
    }
    return files;
}

void checkOptions(const ScanMapOptions& options, std::size_t files) {
    const auto positive = [](double value, const char* option) {
        if (std::isfinite(value) && value > 0.) return;
        throw InputError(option, "", fmt::format("{} is not a positive number", value));
    };
    positive(options.resolution, "--resolution");
    positive(options.maxRange, "--max-range");
    if (options.scanner && files > 1) {
        throw InputError("--scanner", "",
                         fmt::format("one place for {} files; map them one by one, or let the "
                                     "files have it (element camera, as PCL writes it)",
                                     files));
    }
}

/// Fuses one file, streaming.
FusedScan fuseStation(TexturedOcTree& map, const Scan& scan, const ScanMapOptions& options) {
    FusedScan fused;
    fused.file = scan.file;
    fused.points = scan.cloud.size();
    fused.scanner = options.scanner ? options.scanner : scan.cloud.scanner();
    const Stopwatch watch;
    const auto points = [&](const std::function<void(const ScanPoint&)>& visit) {
        fused.used = 0;
        scan.cloud.read([&](const ScanPoint& point) {
            ++fused.used;
            visit(point);
        });
        if (fused.used == 0) throw InputError(scan.file.string(), "", "no point is finite");
    };
    try {
        fuseScan(map, points, fused.scanner, options.maxRange);
    } catch (const std::invalid_argument&) {
        throw InputError(scan.file.string(), "",
                         fmt::format("the points reach too far for cells of {} m: take a "
                                     "larger --resolution or a smaller --max-range",
                                     options.resolution));
    }
    fused.seconds = watch.seconds();
    return fused;
}

}  // namespace

bool isScan(const std::string& path) {
    if (fs::is_directory(path))
        return !fs::exists(fs::path(path) / "rgb.txt") && !plyFiles(path).empty();
    return fs::path(path).extension() == ".ply";
}

std::vector<Scan> openScans(const ScanMapOptions& options) {
    const std::set<fs::path> files = plyFiles(options.scans);
    checkOptions(options, files.size());
    std::vector<Scan> scans;
    scans.reserve(files.size());
    for (const fs::path& file : files) scans.push_back({file, PointCloudFile(file.string())});
    return scans;
}

std::vector<FusedScan> fuseScans(TexturedOcTree& map, const std::vector<Scan>& scans,
                                 const ScanMapOptions& options, const IsStopped& isStopped,
                                 const std::function<void(std::size_t, std::size_t)>& progress) {
    map.setProbHit(kHit);
    map.setProbMiss(kMiss);
    std::vector<FusedScan> fused;
    for (const Scan& scan : scans) {
        if (isStopped && isStopped()) break;
        fused.push_back(fuseStation(map, scan, options));
        if (progress) progress(fused.size(), scans.size());
    }
    return fused;
}

}  // namespace photonav
