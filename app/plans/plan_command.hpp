// SPDX-License-Identifier: BSD-3-Clause
// `photonav plan`: a perception-aware path in a known scene or map.
#pragma once

#include <atomic>

#include "shared/command_io.hpp"

namespace photonav {

struct PlanOptions : CommandOptions {
    bool audit = false;      ///< print what replaying every stored belief from the start gave
    bool evolution = false;  ///< show how the trees of RRT* and of the planner grow
};

/// Plans and writes result.json and the files of writePlanReport(). In a map without grey values it
/// warns and plans without views.
/// @param interrupted when set, planning ends with what it has (exit code 130)
/// @return the exit code
/// @throws InputError for bad input, before anything is written
int runPlan(const PlanOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
