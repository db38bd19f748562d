// SPDX-License-Identifier: BSD-3-Clause
// `photonav map`: makes a textured OctoMap from a recording.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "mapping/map_options.hpp"
#include "shared/command_report.hpp"

namespace photonav {

struct MapCommandOptions : MapOptions {
    std::filesystem::path out;  ///< result folder; created if it does not exist
    int compareEvery = 10;      ///< every n-th used frame is compared with its prediction from the
                                ///< finished map; 0: none
    std::string commandLine;    ///< the command as typed, for the report

    /// Called after each fused frame with the number of frames done and their total number.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// Called before each frame is compared.
    std::function<void(std::size_t done, std::size_t total)> comparison;
};

/// Makes a map from a dataset and writes into options.out:
///
/// - map.ot (TexturedOcTree), map_color.ot (ColorOcTree, for octovis), map.bt (occupancy) and
///   surfaces.ply (points with normals);
/// - trajectory.tum: T_w_c of the used frames, in the world frame of the map;
/// - config.yaml, from which `photonav plan` finds the recorded frames;
/// - comparison_N.png: observed image, predicted image and difference for at most four frames;
/// - convergence.png, only for depth from the images alone: the state of a few depth filters;
/// - result.json, report.json and report.html.
///
/// The world frame of the map has z up; "up" in result.json is the upward direction in the recorded
/// world frame.
/// @param interrupted when set, the map of the frames so far is written, and no more frames are
///        compared
/// @return exit code kNoAnswer if the map is empty
/// @throws InputError for a dataset that cannot be used, for an option out of range, and for a
///         folder that cannot be written. The folder is checked before any frame is fused; no new
///         folder is left.
CommandReport runMap(const MapCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
