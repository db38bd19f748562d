// SPDX-License-Identifier: BSD-3-Clause
// What result.json says of a replay's input, and its model of COLMAP.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "replay/replay.hpp"

namespace photonav {

/// The options in use.
nlohmann::json optionsJson(const ReplayOptions& options);

/// The recording.
nlohmann::json datasetJson(const Replay& replay);

/// The images that were tracked with their estimated poses, as a model of COLMAP: their files are
/// named as from the folder of the dataset. Rectified images, and those of a bag, are no files.
void writeColmap(const std::filesystem::path& folder, const Replay& replay, const ReplayRun& run);

}  // namespace photonav
