// SPDX-License-Identifier: BSD-3-Clause
// result.json of a plan.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "problem/planning_problem.hpp"

namespace photonav {

/// result.json of `photonav plan`; time.total_s (until the report is drawn) is the caller's to
/// fill.
/// @param kappa of the cost [1/m]
nlohmann::json planResult(const Config& config, double kappa, const PlanOutcome& outcome,
                          const std::optional<EvaluatedPath>& baseline, bool interrupted);

}  // namespace photonav
