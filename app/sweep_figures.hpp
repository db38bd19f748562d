// SPDX-License-Identifier: BSD-3-Clause
// Pictures of many runs.
#pragma once

#include <string>
#include <vector>

#include "figures.hpp"
#include "planner_benchmark.hpp"
#include "sweep_summary.hpp"

namespace photonav {

/// Length, mean trace and trace at the goal against alpha: a curve per planner, with one standard
/// deviation up and down, and what the paper reports.
Png drawSweepCurves(const std::string& title, const std::vector<SweepCell>& cells);

/// What a metre buys: mean trace against length. Small dots are runs, discs the means of an alpha;
/// those that nothing of the same planner beats in both are joined, the planner's Pareto front.
Png drawSweepFront(const std::string& title, const std::vector<SweepCell>& cells,
                   const std::vector<SweepRun>& runs);

/// Best cost over time (logarithmic), a line per run, coloured by planner.
Png drawCostOverTime(const std::string& title, const std::vector<std::string>& planners,
                     const std::vector<BenchmarkCurve>& curves);

/// The cheapest path of a planner for every alpha, coloured from dark (0) to bright (1).
std::vector<DrawnPath> pathsByAlpha(const std::string& planner, const std::vector<SweepRun>& runs);

/// Indices of the cells of one planner whose mean length and mean trace are not both beaten by
/// another one's of the same planner, by increasing length.
std::vector<std::size_t> paretoFront(const std::string& planner,
                                     const std::vector<SweepCell>& cells);

}  // namespace photonav
