// SPDX-License-Identifier: BSD-3-Clause
// Figures of sweeps and benchmarks.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "plot/figure.hpp"
#include "shapes/paths.hpp"
#include "sweep/planner_benchmark.hpp"
#include "sweep/sweep_summary.hpp"

namespace photonav {

/// Length, mean trace and trace at the goal over alpha: one curve per planner with error bars of
/// one standard deviation, and the paper's values.
Figure sweepFigure(const std::string& title, const std::vector<SweepCell>& cells);

/// Mean trace over length. Small dots are runs, large dots the means for an alpha. A line joins the
/// Pareto front of each planner: its means that are not dominated by another one.
Figure frontFigure(const std::string& title, const std::vector<SweepCell>& cells,
                   const std::vector<SweepRun>& runs);

/// Best cost over time (logarithmic time axis), one line per run.
Figure costOverTimeFigure(const std::string& title, const std::vector<std::string>& planners,
                          const std::vector<BenchmarkCurve>& curves);

/// The run of least cost of a planner for each alpha; an alpha without a path is left out.
std::map<double, const SweepRun*> cheapestRuns(const std::string& planner,
                                               const std::vector<SweepRun>& runs);

/// The Pareto front of a planner: indices of its cells that are not dominated in mean length and
/// mean trace by another cell of the planner, in the order of increasing length.
std::vector<std::size_t> paretoFront(const std::string& planner,
                                     const std::vector<SweepCell>& cells);

}  // namespace photonav
