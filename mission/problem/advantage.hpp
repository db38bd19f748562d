// SPDX-License-Identifier: BSD-3-Clause
// What a perception-aware path gains over the shortest one.
#pragma once

#include <string>

#include "problem/planning_problem.hpp"

namespace photonav {

/// Costs that differ by less, as a share, are the same.
inline constexpr double kLeastAdvantage = 0.01;

/// Why a path has no advantage over the shortest one: its cost is not lower by kLeastAdvantage.
/// "no advantage: ..." with the reason, or an empty text where it has one.
/// @param alpha of both costs
std::string noAdvantage(const EvaluatedPath& path, const EvaluatedPath& shortest, double alpha);

/// "12 % length, 88 % uncertainty": the shares of the cost.
std::string costShares(const EvaluatedPath& path);

}  // namespace photonav
