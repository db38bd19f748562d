// SPDX-License-Identifier: BSD-3-Clause
// Ways to plan in a scene that comes into view: a planner, and what is done with its plans.
#pragma once

#include <optional>
#include <string>

#include "planners/path_headings.hpp"

namespace photonav {

enum class Replanning {
    repair,   ///< tree or roadmap are kept and repaired as the map changes
    scratch,  ///< a new tree or roadmap after every change; views of unchanged space are kept
    never     ///< the first plan is flown to its end, or until an obstacle is seen on it
};

/// As it is named in a config: a planner, or a planner and a policy, "rrt_star/forward".
struct ExplorePlanner {
    std::string name;                            ///< one of plannerNames()
    std::optional<Headings> headings;            ///< "fixed", "forward"; none: the planner's
    Replanning replanning = Replanning::repair;  ///< "replan": scratch, "once": never
};

/// @throws std::invalid_argument for an unknown planner or policy
ExplorePlanner explorePlanner(const std::string& name);

}  // namespace photonav
