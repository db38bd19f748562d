// SPDX-License-Identifier: BSD-3-Clause
// `photonav calibrate-depth`: estimates the pose of a recording's depth camera relative to its
// colour camera.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "recording/recording.hpp"
#include "shared/command_report.hpp"

namespace photonav {

struct CalibrateDepthOptions : RecordingOptions {
    std::filesystem::path out;  ///< result folder; created if it does not exist

    /// Called after each image with the number of images done and their total number.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Writes camera.yaml, with the pose of the depth camera, and result.json into options.out.
/// @param interrupted when set, nothing is written
/// @throws InputError as registerDepth() does, and for a folder that cannot be written
CommandReport runCalibrateDepth(const CalibrateDepthOptions& options,
                                const std::atomic<bool>& interrupted);

}  // namespace photonav
