// SPDX-License-Identifier: BSD-3-Clause
// Results of flights.
#pragma once

#include "flight/flight_set.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// A panel for every plan, all at the same scale: predicted 1 and 3 sigma of the position along the
/// plan, the errors of all flights and their root mean square.
Figure errorBandsFigure(const std::vector<FlightSet>& sets);

/// NEES per degree of freedom along the plan, mean over the flights; 1 if covariances are
/// consistent.
Figure neesFigure(const std::vector<FlightSet>& sets);

/// True positions of the flights, as lines from above.
DrawnTree drawnFlights(const FlightSet& set);

}  // namespace photonav
