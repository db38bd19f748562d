// SPDX-License-Identifier: BSD-3-Clause
// The advantage of a perception-aware path over the shortest path, in words.
#pragma once

#include <string>

#include "problem/planning_problem.hpp"

namespace photonav {

/// Least relative difference of costs that counts as an advantage.
inline constexpr double kLeastAdvantage = 0.01;

/// The reason why a path has no advantage over the shortest one, "no advantage over the shortest
/// path: ..."; empty if it has one. A path has an advantage if its cost, and also the part of the
/// cost that is charged for uncertainty, is lower by more than kLeastAdvantage times the cost of
/// the shortest path.
/// @param alpha weight of length in both costs
std::string noAdvantage(const EvaluatedPath& path, const EvaluatedPath& shortest, double alpha);

/// The shares of length and uncertainty in the cost: "12 % length, 88 % uncertainty".
std::string costShares(const EvaluatedPath& path);

}  // namespace photonav
