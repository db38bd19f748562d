// SPDX-License-Identifier: BSD-3-Clause
// `photonav calibrate-depth`: where the depth camera of a recording sits.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "recording/recording.hpp"
#include "report/report.hpp"

namespace photonav {

struct CalibrateDepthOptions : RecordingOptions {
    std::filesystem::path out;  ///< folder for the results; made when missing

    /// Called after each image with the number done and the number there are.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

struct CalibrateDepthReport {
    nlohmann::json result;
    ReportTable summary;
    int exitCode = 0;
};

/// Writes camera.yaml, with the pose of the depth camera, and result.json into options.out; nothing
/// when interrupted.
/// @throws InputError as registerDepth(), and for a folder that cannot be written
CalibrateDepthReport runCalibrateDepth(const CalibrateDepthOptions& options,
                                       const std::atomic<bool>& interrupted);

}  // namespace photonav
