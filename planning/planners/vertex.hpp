// SPDX-License-Identifier: BSD-3-Clause
// A sampled state and its number in the tables of a planner.
#pragma once

#include <ompl/base/State.h>

#include <cstdint>

namespace photonav {

struct Vertex {
    ompl::base::State* state = nullptr;  ///< null once the vertex was removed
    std::uint32_t index = 0;  ///< of the vertex in every table that a planner keeps by vertex
    bool isGoal = false;
};

}  // namespace photonav
