// SPDX-License-Identifier: BSD-3-Clause
// result.json of a plan.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "problem/planning_problem.hpp"

namespace photonav {

/// The content of result.json of `photonav plan`. The caller must set time.total_s, which includes
/// the drawing of the report.
/// @param kappa weight of uncertainty in the cost [1/m^2]
/// @param baseline the path of RRT*, if it was planned
nlohmann::json planResult(const Config& config, double kappa, const PlanOutcome& outcome,
                          const std::optional<EvaluatedPath>& baseline, bool interrupted);

}  // namespace photonav
