// SPDX-License-Identifier: BSD-3-Clause
// What the report of a result draws, read back from its report.json.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "interchange/foxglove.hpp"
#include "shapes/paths.hpp"

namespace photonav {

// All take the content of a report.json and throw std::exception for what is not as it should be.

std::vector<DrawnPath> drawnPaths(const nlohmann::json& report);

/// The map's cells, and the scene's surfaces as points that are evenly apart; empty: neither.
GreyPoints drawnSurroundings(const nlohmann::json& report);

}  // namespace photonav
