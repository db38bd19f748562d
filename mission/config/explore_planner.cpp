// SPDX-License-Identifier: BSD-3-Clause
#include "config/explore_planner.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "planners/planner_traits.hpp"

namespace photonav {

ExplorePlanner explorePlanner(const std::string& name) {
    const std::size_t slash = name.find('/');
    ExplorePlanner planner;
    planner.name = name.substr(0, slash);
    const std::vector<std::string>& known = plannerNames();
    if (std::ranges::find(known, planner.name) == known.end()) {
        throw std::invalid_argument(
            fmt::format("'{}' is not one of {}", planner.name, fmt::join(known, ", ")));
    }
    if (slash == std::string::npos) return planner;
    const std::string policy = name.substr(slash + 1);
    if (policy == "fixed") {
        planner.headings = Headings::fixed;
    } else if (policy == "forward") {
        planner.headings = Headings::forward;
    } else if (policy == "replan") {
        planner.replanning = Replanning::scratch;
    } else if (policy == "once") {
        planner.replanning = Replanning::never;
    } else {
        throw std::invalid_argument(fmt::format(
            "'{}': the policy '{}' is not one of fixed, forward, replan, once", name, policy));
    }
    return planner;
}

}  // namespace photonav
