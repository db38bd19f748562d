// SPDX-License-Identifier: BSD-3-Clause
// `photonav replay`: runs the tracker on a recorded flight and evaluates the estimates.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "config/key_table.hpp"
#include "replay/replay_options.hpp"
#include "shared/command_report.hpp"

namespace photonav {

struct ReplayCommandOptions : ReplayOptions {
    std::filesystem::path out;  ///< result folder; created if it does not exist
    bool calibrate = false;     ///< also fit scale and least sigmas, and write calibration.yaml
    std::string commandLine;    ///< the command as typed, for the report

    /// Called after each frame with the number of frames done and their total number.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// The keys of the config.yaml that a replay writes into its result folder. `photonav replay` with
/// this file repeats the replay.
/// @param options are set through the table, and must outlive it
KeyTable keysOf(ReplayCommandOptions& options);

/// Replays a dataset and writes into options.out: result.json, config.yaml (complete), frames.csv
/// (one row per frame), trajectory.tum, .kitti, .cov and .ov, groundtruth.tum (T_w_c), cameras.txt,
/// images.txt and points3D.txt (a COLMAP model), errors.png, strips.png, top_view.png, report.json
/// and report.html; with options.calibrate also calibration.yaml.
/// @param interrupted when set, the results contain the frames so far
/// @return exit code kNoAnswer if tracking was lost until the end
/// @throws InputError for a dataset or map that cannot be used, for an option out of range, and,
///         before any frame is tracked, for a folder that cannot be written
CommandReport runReplay(const ReplayCommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
