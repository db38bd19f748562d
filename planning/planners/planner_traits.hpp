// SPDX-License-Identifier: BSD-3-Clause
// Properties of the planners by name. Includes no header of OMPL.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace photonav {

struct PlannerTraits {
    const char* name;
    /// Whether the planner minimises uncertainty as well as length, and so renders views; else it
    /// minimises the length alone.
    bool usesViews;
    /// Red, green and blue in every figure, page and tutorial. The planners' colours are
    /// distinguishable with any colour vision, on white and on a grey map.
    std::array<std::uint8_t, 3> color;
    unsigned mostCompared = 0;  ///< largest number of vertices in comparisons; 0: no limit
};

/// The properties of a planner; null for an unknown name.
const PlannerTraits* findPlanner(std::string_view name);

/// Names of all planners: those that makePlanner() accepts. The first one is the default.
const std::vector<std::string>& plannerNames();

/// PlannerTraits::usesViews of a planner.
/// @throws std::invalid_argument for an unknown name
bool usesViews(const std::string& planner);

}  // namespace photonav
