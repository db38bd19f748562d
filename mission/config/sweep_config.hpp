// SPDX-License-Identifier: BSD-3-Clause
// The section `sweep` of a config: which runs, and what they are compared with.
#pragma once

#include <string>
#include <vector>

namespace photonav {

/// A row of a published table.
struct PaperRow {
    double alpha = 0.;
    double length = 0.;     ///< [m]
    double meanTrace = 0.;  ///< along the path, as printed
    double goalTrace = 0.;  ///< as printed
};

struct SweepConfig {
    std::vector<double> alphas{.05, .15, .25, .35, .45, .55, .65, .75, .85, .95};
    unsigned runs = 10;  ///< per planner and alpha, with the seeds seed, seed + 1, ...
    std::vector<std::string> planners{"belief_rrt_star", "pa_rrt_star", "rrt_star"};
    std::string reference;         ///< CSV of the best known cost per alpha, absolute; may be empty
    std::vector<PaperRow> paper;   ///< what a publication reports for this config
    double paperTraceUnit = 0.01;  ///< value of a printed trace of 1 [m^2]
};

/// Alphas as typed: "first:last:step" (the last one included where the steps meet it) or a list
/// "0.1,0.4,1".
/// @throws InputError naming --alpha
std::vector<double> parseAlphas(const std::string& text);

}  // namespace photonav
