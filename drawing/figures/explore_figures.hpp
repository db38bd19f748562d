// SPDX-License-Identifier: BSD-3-Clause
// Figures of explorations.
#pragma once

#include "exploration/explorations.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

inline constexpr double kMapPixel = 0.025;  ///< of the picture of the map from above [m]

/// The true positions of a flight.
DrawnTree drawnWay(const ExplorationResult& flight);

/// Its beliefs, about ten per metre.
DrawnPath drawnBeliefs(const ExplorationResult& flight, double characteristicLength);

/// Over the way flown: trace of the beliefs, and their NEES; time of the updates.
Figure explorationFigure(const std::vector<ExplorationResult>& flights,
                         double characteristicLength);

/// Trace of the beliefs over the share of the way flown: for every planner the mean of its flights
/// and, of several, the band in which 95 % of them are.
Figure traceBandsFigure(const std::vector<ExplorationResult>& flights, double characteristicLength);

}  // namespace photonav
