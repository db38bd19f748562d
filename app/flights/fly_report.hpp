// SPDX-License-Identifier: BSD-3-Clause
// Writes the result files of flights: trajectories, figures and page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "flight/fly_result.hpp"
#include "report/report.hpp"

namespace photonav {

/// Writes config.yaml, the first flight's trajectory files, errors.png, nees.png, top_view.png,
/// report.json and report.html.
/// @param sets one set of flights per plan, the config's own plan first
/// @param frames frames of the page's animation, see flightFrames()
/// @param result content of result.json
void writeFlyReport(const std::filesystem::path& folder, const Config& config, const World& world,
                    const std::vector<FlightSet>& sets, std::vector<ReportFrame> frames,
                    const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
