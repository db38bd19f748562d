// SPDX-License-Identifier: BSD-3-Clause
// result.json of an exploration.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "exploration/explorations.hpp"

namespace photonav {

/// The flights of an exploration: of one call of the command, or merged from its shards.
struct ExplorationSet {
    std::vector<ExplorationResult> flights;  ///< in the order of trialItems(); the first has a map
    std::vector<ExplorationSummary> summaries = {};  ///< one per planner
    std::size_t ended = 0;  ///< number of complete flights; an interrupted first flight is in
                            ///< `flights`, but does not count
    std::size_t asked = 0;  ///< number of flights of the complete exploration or shard
    bool interrupted = false;
};

/// The content of result.json: the first flight, all trials, and a summary per planner.
nlohmann::json exploreResult(const ExplorationSetup& setup, const ExplorationSet& outcome);

}  // namespace photonav
