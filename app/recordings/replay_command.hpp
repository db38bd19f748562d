// SPDX-License-Identifier: BSD-3-Clause
// `photonav replay`: a recorded flight through the tracker.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "config/key_table.hpp"
#include "replay/replay_options.hpp"
#include "report/report.hpp"

namespace photonav {

struct ReplayCommandOptions : ReplayOptions {
    std::filesystem::path out;  ///< folder for the results; made when missing
    bool calibrate = false;     ///< also write calibration.yaml: scale and least sigmas that fit
    std::string commandLine;    ///< for the report

    /// Called after each frame with the number done and the number there are.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// The keys of the config.yaml that a replay writes into its folder, and repeats when given it.
KeyTable keysOf(ReplayCommandOptions& options);

struct ReplayReport {
    nlohmann::json result;  ///< what was written as result.json
    ReportTable summary;    ///< the same in words
    int exitCode = 0;       ///< 1 when lost for good, 130 when interrupted
};

/// Replays a dataset and writes into options.out: result.json, config.yaml (complete), frames.csv
/// (a row per frame), trajectory.tum, .kitti, .cov and .ov and groundtruth.tum (camera to world),
/// cameras.txt, images.txt and points3D.txt (a model of COLMAP), errors.png, strips.png,
/// top_view.png and report.html.
/// @param interrupted checked between frames; what is there then is written
/// @throws InputError for a dataset or map that cannot be used, an option out of range and a folder
///         that cannot be written, the last before any work is done
ReplayReport runReplay(const ReplayCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
