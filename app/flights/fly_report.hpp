// SPDX-License-Identifier: BSD-3-Clause
// The results of flights: numbers, figures, page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "flight/fly_result.hpp"
#include "report/report.hpp"

namespace photonav {

/// Writes config.yaml, the first flight's trajectory files, errors.png, nees.png, top_view.png,
/// report.json and report.html.
/// @param frames of flights to be played in the page, see flightFrames()
void writeFlyReport(const std::filesystem::path& folder, const Config& config, const World& world,
                    const std::vector<FlightSet>& sets, std::vector<ReportFrame> frames,
                    const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
