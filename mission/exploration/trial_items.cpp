// SPDX-License-Identifier: BSD-3-Clause
// The list of flights, apart from what flies them: journals are read without that.
#include <fmt/format.h>

#include "exploration/explorations.hpp"
#include "runs/work_items.hpp"

namespace photonav {

std::string nameOf(const TrialItem& item) {
    return fmt::format("{} seed {}", item.planner, item.seed);
}

std::vector<std::string> plannersOf(const Config& config) {
    const std::vector<std::string>& planners = config.explore.planners;
    return planners.empty() ? std::vector{config.planner} : planners;
}

std::vector<TrialItem> trialItems(const Config& config) {
    const unsigned trials = config.explore.trials;
    checkSeeds(config, trials);
    std::vector<TrialItem> items;
    for (const std::string& planner : plannersOf(config)) {
        for (unsigned i = 0; i < trials; ++i) items.push_back({planner, config.seed + i});
    }
    return items;
}

}  // namespace photonav
