// SPDX-License-Identifier: BSD-3-Clause
// Writes the result files of a check of a trajectory: figures and page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "check/check_result.hpp"
#include "report/report.hpp"

namespace photonav {

/// The main numbers of a check, for the terminal and the page.
ReportTable summaryOf(const CheckOutcome& report);

/// Writes config.yaml, path.tum, path.kitti, the figures, report.json and report.html.
/// @param result content of result.json
void writeCheckReport(const std::filesystem::path& folder, const CheckOutcome& report,
                      const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
