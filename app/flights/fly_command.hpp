// SPDX-License-Identifier: BSD-3-Clause
// `photonav fly`: a plan flown in closed loop, many times, beside the shortest path.
#pragma once

#include <atomic>
#include <string>

#include "shared/command_io.hpp"

namespace photonav {

/// All that the results depend on is in the config (FlyConfig) and its overrides.
struct FlyOptions : CommandOptions {
    unsigned jobs = 1;             ///< threads
    std::string calibration;       ///< file whose scale and least sigmas are among the overrides
    std::filesystem::path record;  ///< folder for the first flight as a recording; empty: none
};

/// Plans (or takes the plan of a result folder), flies it and writes result.json, config.yaml,
/// trajectory.tum, .cov and .ov and groundtruth.tum of the first flight, errors.png, nees.png,
/// top_view.png, report.json and report.html.
/// @param interrupted when set, flying ends with the flights that were flown (exit code 130)
/// @return the exit code: kNoAnswer when there was no path or no flight of the config's own planner
///         arrived (whether RRT*'s did does not count)
/// @throws InputError for bad input, before anything is written
int runFly(const FlyOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
