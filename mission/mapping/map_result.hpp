// SPDX-License-Identifier: BSD-3-Clause
// result.json of a map.
#pragma once

#include <nlohmann/json.hpp>

#include "mapping/recording_map.hpp"

namespace photonav {

/// How many cells are free and occupied, and the box of the occupied ones.
nlohmann::json voxelsJson(const TexturedOcTree& map);

/// result.json but for the cells and the time it took.
/// @param compared frames and their predictions
nlohmann::json mapResult(const MapOptions& options, const Recording& recording,
                         const FusedRecording& run, const nlohmann::json& compared,
                         bool interrupted);

}  // namespace photonav
