// SPDX-License-Identifier: BSD-3-Clause
// Flights of a path and their results.
#pragma once

#include <functional>

#include "bindings.hpp"
#include "flight/flight_set.hpp"

namespace photonav::python {

/// Without the interpreter's lock.
FlightSet flyAlong(const PlanningProblem& problem, const EvaluatedPath& path, unsigned flights,
                   unsigned jobs, const std::atomic<bool>& interrupted,
                   const std::function<void()>& onFlight);

/// As photonav/__init__.pyi says of Problem.fly().
py::dict resultOf(const FlightSet& set);

}  // namespace photonav::python
