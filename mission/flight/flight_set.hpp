// SPDX-License-Identifier: BSD-3-Clause
// The flights of one plan, and the path that it was made of.
#pragma once

#include "flight/flight_statistics.hpp"
#include "flight/flights.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {

struct FlightSet {
    EvaluatedPath path;
    std::vector<PlannedView> plan;
    std::vector<FlightResult> flights;
};

inline FlightSummary summarise(const FlightSet& set) { return summarise(set.flights, set.plan); }

}  // namespace photonav
