// SPDX-License-Identifier: BSD-3-Clause
// What came of flights, drawn.
#pragma once

#include "figures.hpp"
#include "fly_runs.hpp"

namespace photonav {

/// The colour of a planner's flights: the first one's, or that of what it is compared with.
inline Color colorOf(std::size_t set) { return set == 0 ? kPathColor : kBaselineColor; }

/// A panel for every plan, all at the same scale: predicted 1 and 3 sigma of the position along the
/// way, the errors of all flights and their root mean square. Sets without flights are left out.
Png drawErrorBands(const std::vector<FlightSet>& sets);

/// NEES per degree of freedom along the way, mean over the flights; 1 is honest.
Png drawNees(const std::vector<FlightSet>& sets);

/// Where the flights truly went, as lines from above.
DrawnTree drawnFlights(const FlightSet& set, const Color& color);

}  // namespace photonav
