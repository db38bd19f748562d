// SPDX-License-Identifier: BSD-3-Clause
#include "commands/sweep_lists.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/config.hpp"

namespace photonav {

std::vector<std::string> SweepLists::after(std::vector<std::string> overrides) const {
    if (alphas) {
        overrides.push_back(
            fmt::format("sweep.alphas=[{}]", fmt::join(parseAlphas(*alphas), ", ")));
    }
    if (planners) overrides.push_back("sweep.planners=[" + *planners + "]");
    if (runs) overrides.push_back(fmt::format("sweep.runs={}", *runs));
    if (seed) overrides.push_back("seed=" + *seed);
    return overrides;
}

}  // namespace photonav
