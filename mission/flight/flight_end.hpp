// SPDX-License-Identifier: BSD-3-Clause
// How flights end.
#pragma once

#include <string>

namespace photonav {

enum class FlightEnd {
    arrived,    ///< reported at the goal, and is there
    astray,     ///< reported at the goal, but is not there
    uncertain,  ///< the best estimate is at the goal, but not certain enough to report it
    collided,
    lost,   ///< gave up searching
    noWay,  ///< the map that the robot made shows none
    outOfTime,
    stopped,  ///< by the caller
};
std::string nameOf(FlightEnd end);

}  // namespace photonav
