// SPDX-License-Identifier: BSD-3-Clause
// Reads the drawn objects of a report from its report.json.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "interchange/foxglove.hpp"
#include "shapes/paths.hpp"

namespace photonav {

// `report` is the content of a report.json. All functions throw std::exception if it is damaged.

/// The paths with their beliefs.
std::vector<DrawnPath> drawnPaths(const nlohmann::json& report);

/// The centres of the map's drawn cells, and points spread evenly over the scene's surfaces, with
/// their grey values; empty if the report has neither.
GreyPoints drawnSurroundings(const nlohmann::json& report);

}  // namespace photonav
