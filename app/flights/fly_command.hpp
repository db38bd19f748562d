// SPDX-License-Identifier: BSD-3-Clause
// `photonav fly`: flies a plan, and the shortest path for comparison, in closed loop, many times.
#pragma once

#include <atomic>
#include <string>

#include "shared/command_io.hpp"

namespace photonav {

/// Options of the command. The flights depend only on the config (FlyConfig) with its overrides.
struct FlyOptions : CommandOptions {
    unsigned jobs = 1;             ///< number of threads
    std::string calibration;       ///< calibration.yaml whose scale and least sigmas are among the
                                   ///< overrides; empty: none
    std::filesystem::path record;  ///< folder for a recording of the first flight; empty: none
};

/// Plans, or reads the plan of a result folder, and flies the plan. Writes result.json,
/// config.yaml, errors.png, nees.png, top_view.png, report.json and report.html, and for the first
/// flight trajectory.tum, .cov and .ov, and groundtruth.tum.
/// @param interrupted when set, the results contain the flights so far (exit code 130)
/// @return the exit code: kNoAnswer if there is no path, or no flight along it arrived; flights of
///         RRT* for comparison do not count
/// @throws InputError for bad input, before anything is written
int runFly(const FlyOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
