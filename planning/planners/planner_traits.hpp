// SPDX-License-Identifier: BSD-3-Clause
// What is known of a planner by its name, without OMPL.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace photonav {

struct PlannerTraits {
    const char* name;
    /// Whether it minimises uncertainty as well, and so renders views. The others minimise the
    /// length alone.
    bool usesViews;
    /// Red, green and blue in every figure, page and tutorial: distinguishable from those of the
    /// others with any colour vision, on white and on a grey map.
    std::array<std::uint8_t, 3> color;
    unsigned mostCompared = 0;  ///< largest number of vertices in comparisons; 0: no limit
};

/// @return null for an unknown name
const PlannerTraits* findPlanner(std::string_view name);

/// Names of all planners: those that makePlanner() accepts.
const std::vector<std::string>& plannerNames();

/// @throws std::invalid_argument for an unknown name
bool usesViews(const std::string& planner);

}  // namespace photonav
