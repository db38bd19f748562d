// SPDX-License-Identifier: BSD-3-Clause
// A flight as the page plays it.
#pragma once

#include "flight/flight_set.hpp"
#include "flightlog/sparse_exposures.hpp"
#include "report/report.hpp"

namespace photonav {

/// Images of a flight, the views that the map predicts at the believed poses, and their
/// differences.
/// @param exposures of the flight
std::vector<ReportFrame> flightFrames(const std::string& planner, const FlightResult& flight,
                                      const std::vector<KeptExposure>& exposures,
                                      const FlightWorld& world);

}  // namespace photonav
