// SPDX-License-Identifier: BSD-3-Clause
// `photonav map`: a recorded sequence becomes a textured OctoMap.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "mapping/map_options.hpp"
#include "report/report.hpp"

namespace photonav {

struct MapCommandOptions : MapOptions {
    std::filesystem::path out;  ///< folder for the results; made when missing
    int compareEvery = 10;      ///< predict every n-th used frame from the finished map; 0: none
    std::string commandLine;    ///< for the report

    /// Called after each fused frame with the number done and the number there are.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

struct MapReport {
    nlohmann::json result;  ///< what was written as result.json
    ReportTable summary;    ///< the same in words
    int exitCode = 0;       ///< 130 when interrupted
};

/// Maps a dataset and writes into options.out: map.ot (TexturedOcTree), map_color.ot (ColorOcTree,
/// for octovis), map.bt, surfaces.ply (points with normals), trajectory.tum (camera to world, of
/// the frames used, in the map's world), config.yaml (with it `plan` finds the frames again),
/// result.json, comparison_N.png (observed, predicted and difference of up to four frames), with
/// depth from the images alone convergence.png (what a few references have learned of every pixel),
/// report.json and report.html. The world of the map has z up: `up` states how the recorded world
/// was turned.
/// @param interrupted checked between frames; what is there then is written, without comparison
/// @throws InputError for a dataset that cannot be used, an option out of range ("--every") and a
///         folder that cannot be written, the last before any work is done; no new folder is left
MapReport runMap(const MapCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
