// SPDX-License-Identifier: BSD-3-Clause
// Results of many runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "plot/figure.hpp"
#include "shapes/paths.hpp"
#include "sweep/planner_benchmark.hpp"
#include "sweep/sweep_summary.hpp"

namespace photonav {

/// Length, mean trace and trace at the goal over alpha: a curve per planner, with one standard
/// deviation up and down, and the paper's values.
Figure sweepFigure(const std::string& title, const std::vector<SweepCell>& cells);

/// Mean trace over length. Small dots are runs, large ones the means of an alpha; those that are
/// not dominated by another one of the same planner are joined, the planner's Pareto front.
Figure frontFigure(const std::string& title, const std::vector<SweepCell>& cells,
                   const std::vector<SweepRun>& runs);

/// Best cost over time (logarithmic), a line per run.
Figure costOverTimeFigure(const std::string& title, const std::vector<std::string>& planners,
                          const std::vector<BenchmarkCurve>& curves);

/// The cheapest run of a planner for every alpha that has a path, by alpha.
std::map<double, const SweepRun*> cheapestRuns(const std::string& planner,
                                               const std::vector<SweepRun>& runs);

/// Indices of the cells of one planner whose mean length and mean trace are not both beaten by
/// another one's of the same planner, by increasing length.
std::vector<std::size_t> paretoFront(const std::string& planner,
                                     const std::vector<SweepCell>& cells);

}  // namespace photonav
