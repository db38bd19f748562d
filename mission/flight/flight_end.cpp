// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_end.hpp"

namespace photonav {

std::string nameOf(FlightEnd end) {
    switch (end) {
        case FlightEnd::arrived:
            return "arrived";
        case FlightEnd::astray:
            return "astray";
        case FlightEnd::uncertain:
            return "uncertain arrival";
        case FlightEnd::collided:
            return "collided";
        case FlightEnd::lost:
            return "lost";
        case FlightEnd::noWay:
            return "no way";
        case FlightEnd::outOfTime:
            return "out of time";
        case FlightEnd::stopped:
            break;
    }
    return "stopped";
}

}  // namespace photonav
