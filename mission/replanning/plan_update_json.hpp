// SPDX-License-Identifier: BSD-3-Clause
// Plan updates as JSON, for results, journals and logs.
#pragma once

#include <nlohmann/json.hpp>

#include "replanning/online_planner.hpp"

namespace photonav {

/// An update without wall-clock times, which journals store in seconds and results in milliseconds.
/// Cost and length are null if there is no path.
nlohmann::json untimedJson(const PlanUpdate& update);

/// An update with wall-clock times [s], for journals.
nlohmann::json lineOf(const PlanUpdate& update);
/// The inverse of lineOf(). @throws std::exception for missing or impossible values
PlanUpdate planUpdateFrom(const nlohmann::json& line);

}  // namespace photonav
