// SPDX-License-Identifier: BSD-3-Clause
#include "config/explore_strategy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "planners/planner_table.hpp"

namespace photonav {

ExploreStrategy exploreStrategy(const std::string& name) {
    const std::size_t slash = name.find('/');
    ExploreStrategy strategy;
    strategy.planner = name.substr(0, slash);
    const std::vector<std::string>& known = plannerNames();
    if (std::ranges::find(known, strategy.planner) == known.end()) {
        throw std::invalid_argument(
            fmt::format("'{}' is not one of {}", strategy.planner, fmt::join(known, ", ")));
    }
    if (slash == std::string::npos) return strategy;
    const std::string policy = name.substr(slash + 1);
    if (policy == "fixed") {
        strategy.headings = Headings::fixed;
    } else if (policy == "forward") {
        strategy.headings = Headings::forward;
    } else if (policy == "replan") {
        strategy.replanning = Replanning::scratch;
    } else if (policy == "once") {
        strategy.replanning = Replanning::never;
    } else {
        throw std::invalid_argument(fmt::format(
            "'{}': the policy '{}' is not one of fixed, forward, replan, once", name, policy));
    }
    return strategy;
}

}  // namespace photonav
