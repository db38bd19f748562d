// SPDX-License-Identifier: BSD-3-Clause
// The results of flights: numbers, figures, page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "flight/flight_set.hpp"
#include "report/report.hpp"

namespace photonav {

/// result.json of `photonav fly`; seconds are the caller's to fill.
nlohmann::json flyResult(const Config& config, const std::vector<FlightSet>& sets,
                         const FlightOptions& options, bool interrupted);

/// Writes config.yaml, the first flight's trajectory files, errors.png, nees.png, top_view.png,
/// report.json and report.html.
/// @param frames of flights to be played in the page, see flightFrames()
void writeFlyReport(const std::filesystem::path& folder, const Config& config, const World& world,
                    const std::vector<FlightSet>& sets, std::vector<ReportFrame> frames,
                    const std::string& commandLine, const nlohmann::json& result);

/// trajectory.tum, .cov and .ov (believed), groundtruth.tum.
void writeFlownTrajectory(const std::filesystem::path& folder, const FlightResult& flight);

/// "0.537 m", "3.75 mm".
std::string lengthText(double metres);

}  // namespace photonav
