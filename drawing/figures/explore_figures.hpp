// SPDX-License-Identifier: BSD-3-Clause
// Figures of explorations.
#pragma once

#include "exploration/explorations.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

inline constexpr double kMapPixel = 0.025;  ///< pixel of the picture of the map from above [m]

/// The true camera positions of a flight.
DrawnTree drawnWay(const ExplorationResult& flight);

/// The beliefs of a flight, about ten per metre. They have no cost (PathPoint::cost is 0).
/// @param characteristicLength see weightedTrace() [m]
DrawnPath drawnBeliefs(const ExplorationResult& flight, double characteristicLength);

/// Three panels over the distance flown: weighted trace of the beliefs, NEES, and wall-clock time
/// of the updates of the plan.
Figure explorationFigure(const std::vector<ExplorationResult>& flights,
                         double characteristicLength);

/// Weighted trace of the beliefs over the share of the distance flown: for every planner the mean
/// over its flights and, for several flights, the band that contains 95 % of them.
Figure traceBandsFigure(const std::vector<ExplorationResult>& flights, double characteristicLength);

}  // namespace photonav
