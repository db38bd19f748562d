// SPDX-License-Identifier: BSD-3-Clause
// result.json of an exploration.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "exploration/explorations.hpp"

namespace photonav {

/// The flights of an exploration, of one run or merged from shards.
struct ExplorationSet {
    std::vector<ExplorationResult> flights;  ///< in the order of trialItems(); the first with a map
    std::vector<ExplorationSummary> summaries = {};  ///< one per planner
    std::size_t ended = 0;                           ///< without a first one that was interrupted
    std::size_t asked = 0;                           ///< flights there should be
    bool interrupted = false;
};

/// The content of result.json: the first flight, all trials, and a summary per planner.
nlohmann::json exploreResult(const ExplorationSetup& setup, const ExplorationSet& outcome);

}  // namespace photonav
