// SPDX-License-Identifier: BSD-3-Clause
// The input of a replay as part of result.json, and the result as a COLMAP model.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "replay/replay.hpp"

namespace photonav {

/// The options in use.
/// @param options completed by Replay::options()
nlohmann::json optionsJson(const ReplayOptions& options);

/// The recording: folder, layout, camera and depth.
nlohmann::json datasetJson(const Replay& replay);

/// Writes the tracked images with their estimated poses as a COLMAP model. Image files are named
/// relative to the folder of the dataset. Nothing is written for recordings without image files
/// (Recording::hasImageFiles).
void writeColmap(const std::filesystem::path& folder, const Replay& replay, const ReplayRun& run);

}  // namespace photonav
