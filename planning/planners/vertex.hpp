// SPDX-License-Identifier: BSD-3-Clause
// A vertex of a planner: a sampled state and its index.
#pragma once

#include <ompl/base/State.h>

#include <cstdint>

namespace photonav {

struct Vertex {
    ompl::base::State* state = nullptr;  ///< null once the vertex was removed
    std::uint32_t index = 0;             ///< index in every table that a planner has by vertex
    bool isGoal = false;
};

}  // namespace photonav
