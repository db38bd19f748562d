// SPDX-License-Identifier: BSD-3-Clause
// What a config says about `photonav sweep`: which runs, and what they are compared with.
#pragma once

#include <string>
#include <vector>

#include "yaml_reader.hpp"

namespace photonav {

/// A row of a published table.
struct PaperRow {
    double alpha = 0.;
    double length = 0.;     ///< [m]
    double meanTrace = 0.;  ///< along the way, as printed
    double goalTrace = 0.;  ///< as printed
};

struct SweepConfig {
    std::vector<double> alphas{.05, .15, .25, .35, .45, .55, .65, .75, .85, .95};
    unsigned runs = 10;  ///< per planner and alpha, with the seeds seed, seed + 1, ...
    std::vector<std::string> planners{"belief_rrt_star", "pa_rrt_star", "rrt_star"};
    std::string reference;         ///< CSV of the best known cost per alpha, absolute; may be empty
    std::vector<PaperRow> paper;   ///< what a publication reports for this config
    double paperTraceUnit = 0.01;  ///< what a printed trace of 1 stands for [m^2 + rad^2]
};

/// Reads the config's `sweep`.
/// @throws InputError for an alpha outside [0, 1] or given twice, an unknown planner, no runs
SweepConfig readSweep(YamlMap& root, const std::vector<std::string>& knownPlanners);

/// The same as YAML that readSweep() reads back.
std::string toYaml(const SweepConfig& sweep);

/// Alphas as typed: "first:last:step" (the last one included where the steps meet it) or a list
/// "0.1,0.4,1".
/// @throws InputError naming --alpha
std::vector<double> parseAlphas(const std::string& text);

}  // namespace photonav
