// SPDX-License-Identifier: BSD-3-Clause
// Result files of flights.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "config/config.hpp"
#include "flight/flight_set.hpp"

namespace photonav {

/// result.json of `photonav fly`; seconds are the caller's to fill.
nlohmann::json flyResult(const Config& config, const std::vector<FlightSet>& sets,
                         const FlightOptions& options, bool interrupted);

/// Numbers of the flights of a plan; null where there is none.
nlohmann::json flightSummaryJson(const FlightSummary& summary);

/// trajectory.tum, .cov and .ov (believed), groundtruth.tum.
void writeFlownTrajectory(const std::filesystem::path& folder, const FlightResult& flight);

}  // namespace photonav
