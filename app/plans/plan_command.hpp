// SPDX-License-Identifier: BSD-3-Clause
// `photonav plan`: plans a perception-aware path in a known scene or map.
#pragma once

#include <atomic>

#include "shared/command_io.hpp"

namespace photonav {

struct PlanOptions : CommandOptions {
    bool audit = false;      ///< also propagate each stored belief again from the start, and print
                             ///< the largest errors
    bool evolution = false;  ///< also show how the trees of RRT* and of the planner grow
};

/// Plans a path and writes result.json and the files of writePlanReport(). For a map without grey
/// values, it prints a warning and plans without views.
/// @param interrupted when set, planning ends with the best path so far (exit code 130)
/// @return the exit code: kNoAnswer if there is no path of finite cost
/// @throws InputError for bad input, before anything is written
int runPlan(const PlanOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
