// SPDX-License-Identifier: BSD-3-Clause
// What a flight in real time missed, for results, journals and reports.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "exploration/real_time_monitor.hpp"

namespace photonav {

/// For results and journals; durations in seconds.
nlohmann::json realTimeJson(const RealTimeSummary& summary);
/// The inverse of realTimeJson(). @throws std::exception for missing or impossible values
RealTimeSummary realTimeFrom(const nlohmann::json& values);

/// The same in words, one line per name.
std::vector<std::pair<std::string, std::string>> realTimeRows(const RealTimeSummary& summary);

}  // namespace photonav
