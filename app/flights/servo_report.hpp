// SPDX-License-Identifier: BSD-3-Clause
// The report of a study of photometric servoing at a goal.
#pragma once

#include <filesystem>
#include <string>

#include "problem/world.hpp"
#include "report/report.hpp"
#include "servo/servo_result.hpp"

namespace photonav {

/// Input and outcome of a study.
struct ServoReport {
    const Config& config;
    const World& world;
    const ServoGoal& goal;
    const ServoStudyOptions& options;
    const ServoStudy& study;
};

/// The main numbers of a study, for the terminal and the page.
ReportTable servoSummary(const ServoReport& report);

/// Writes all files of the result folder except result.json.
/// @param result content of result.json
void writeServoReport(const std::filesystem::path& folder, const ServoReport& report,
                      const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
