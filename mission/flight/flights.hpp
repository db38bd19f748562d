// SPDX-License-Identifier: BSD-3-Clause
// Many flights of a plan.
#pragma once

#include <atomic>
#include <vector>

#include "flight/flight.hpp"

namespace photonav {

/// Flies number 0 to `count` - 1 on `jobs` threads; the seed of a flight follows from
/// options.seed and its number, so that flights of different plans draw the same numbers.
/// @param onFlight called as flights end, in any order, one at a time
/// @param onExposure of flight 0
/// @return in order of their number, without those that were interrupted
std::vector<FlightResult> flyMany(const std::vector<PlannedView>& plan, const FlightWorld& world,
                                  const FlightOptions& options, unsigned count, unsigned jobs,
                                  const std::atomic<bool>& interrupted,
                                  const std::function<void(const FlightResult&)>& onFlight = {},
                                  const OnExposure& onExposure = {});

}  // namespace photonav
