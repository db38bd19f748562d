// SPDX-License-Identifier: BSD-3-Clause
// The results of checking a trajectory: numbers, figures, page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "check/check_result.hpp"
#include "report/report.hpp"

namespace photonav {

/// The summary, for the terminal and the page.
ReportTable summaryOf(const CheckOutcome& report);

/// Writes config.yaml, path.tum, the figures of checkFigures(), report.json and report.html.
void writeCheckReport(const std::filesystem::path& folder, const CheckOutcome& report,
                      const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
