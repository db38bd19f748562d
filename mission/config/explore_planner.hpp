// SPDX-License-Identifier: BSD-3-Clause
// Planning during an exploration: a planner, its headings and its replanning policy.
#pragma once

#include <optional>
#include <string>

#include "planners/path_headings.hpp"

namespace photonav {

enum class Replanning {
    repair,   ///< the tree or roadmap is kept, and repaired when the map changes
    scratch,  ///< a new tree or roadmap after every change; views of unchanged space are kept
    never     ///< the first plan is flown to its end, or until an obstacle is observed on it
};

/// A planner and an optional policy, as named in a config: "rrt_star" or "rrt_star/forward".
struct ExplorePlanner {
    std::string name;                  ///< one of plannerNames()
    std::optional<Headings> headings;  ///< policies "fixed", "forward"; none: the planner chooses
    Replanning replanning = Replanning::repair;  ///< policies "replan" (scratch), "once" (never)
};

/// Parses a name as used in `explore.planners`.
/// @throws std::invalid_argument for an unknown planner or policy
ExplorePlanner explorePlanner(const std::string& name);

}  // namespace photonav
