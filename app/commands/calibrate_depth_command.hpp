// SPDX-License-Identifier: BSD-3-Clause
// `photonav calibrate-depth`: where the depth camera of a recording sits.
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands/command_io.hpp"
#include "recording/recording.hpp"
#include "report/report.hpp"

namespace photonav {

struct CalibrateDepthOptions : RecordingOptions {
    std::filesystem::path out;  ///< folder for the results; made when missing
    bool quiet = false;
    bool json = false;
};

/// Writes camera.yaml, with the pose of the depth camera, and result.json into options.out.
/// @return the exit code
/// @throws InputError as registerDepth(), and for a folder that cannot be written
int runCalibrateDepth(const CalibrateDepthOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
