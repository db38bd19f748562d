// SPDX-License-Identifier: BSD-3-Clause
// The frames of the animation of a flight, for the report.
#pragma once

#include "flight/flight_set.hpp"
#include "flightlog/sparse_exposures.hpp"
#include "report/report.hpp"

namespace photonav {

/// One frame per kept exposure: the observed image, the view that the map predicts at the believed
/// pose, and their difference.
/// @param planner name of the plan's planner, for captions and colour
/// @param exposures kept exposures of this flight
/// @param world gives map and camera
std::vector<ReportFrame> flightFrames(const std::string& planner, const FlightResult& flight,
                                      const std::vector<KeptExposure>& exposures,
                                      const FlightWorld& world);

}  // namespace photonav
