// SPDX-License-Identifier: BSD-3-Clause
// The section `sweep` of a config: the runs of a sweep, and published values to compare them with.
#pragma once

#include <string>
#include <vector>

namespace photonav {

/// A row of a published table.
struct PaperRow {
    double alpha = 0.;
    double length = 0.;     ///< [m]
    double meanTrace = 0.;  ///< mean trace along the path, as printed [paperTraceUnit]
    double goalTrace = 0.;  ///< trace at the goal, as printed [paperTraceUnit]
};

struct SweepConfig {
    std::vector<double> alphas{.05, .15, .25, .35, .45, .55, .65, .75, .85, .95};
    unsigned runs = 10;  ///< runs per planner and alpha, with the seeds seed, seed + 1, ...
    std::vector<std::string> planners{"belief_rrt_star", "pa_rrt_star", "rrt_star"};
    std::string reference;         ///< CSV of the best known cost per alpha, absolute path; may be
                                   ///< empty
    std::vector<PaperRow> paper;   ///< published values for this config
    double paperTraceUnit = 0.01;  ///< value of a printed trace of 1 [m^2]
};

/// Parses values of alpha: "first:last:step" (with `last`, if a whole number of steps leads to it)
/// or a list "0.1,0.4,1".
/// @throws InputError naming --alpha
std::vector<double> parseAlphas(const std::string& text);

}  // namespace photonav
