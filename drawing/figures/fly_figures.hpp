// SPDX-License-Identifier: BSD-3-Clause
// Figures of flights of a plan.
#pragma once

#include "flight/flight_set.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Position errors along each plan, one panel per plan in the same scale: predicted bands of 1 and
/// 3 sigma, the errors of all flights and their root mean square.
Figure errorBandsFigure(const std::vector<FlightSet>& sets);

/// NEES per degree of freedom along the plan, averaged over the flights. It is about 1 if the
/// covariances are consistent.
Figure neesFigure(const std::vector<FlightSet>& sets);

/// The true camera positions of all flights, as lines.
DrawnTree drawnFlights(const FlightSet& set);

}  // namespace photonav
