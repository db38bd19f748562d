// SPDX-License-Identifier: BSD-3-Clause
// Updates of a plan in results, journals and logs.
#pragma once

#include <nlohmann/json.hpp>

#include "exploration/online_planner.hpp"

namespace photonav {

/// An update as journals and results hold it, but for the wall-clock times, which journals keep in
/// seconds and results in milliseconds. Costs and lengths of no way are null.
nlohmann::json untimedJson(const PlanUpdate& update);

/// The same with the wall-clock times [s], and back.
/// @throws std::exception for numbers that no update gives
nlohmann::json lineOf(const PlanUpdate& update);
PlanUpdate planUpdateFrom(const nlohmann::json& line);

/// A duration, length or share of them. @throws std::exception for anything else
double nonNegative(const nlohmann::json& line, const char* key);

/// A number; NaN for null. @throws std::exception for anything else
double numberOrNone(const nlohmann::json& line, const char* key);

}  // namespace photonav
