// SPDX-License-Identifier: BSD-3-Clause
// result.json of a map.
#pragma once

#include <nlohmann/json.hpp>

#include "mapping/recording_map.hpp"

namespace photonav {

/// The numbers of free and occupied cells, and the bounding box of the occupied cells [m].
nlohmann::json voxelsJson(const TexturedOcTree& map);

/// The content of result.json without voxelsJson() and computation times.
/// @param compared differences between frames and their predictions, a JSON list
nlohmann::json mapResult(const MapOptions& options, const Recording& recording,
                         const FusedRecording& run, const nlohmann::json& compared,
                         bool interrupted);

}  // namespace photonav
