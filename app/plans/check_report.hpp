// SPDX-License-Identifier: BSD-3-Clause
// The results of checking a trajectory: numbers, figures, page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "check/localisation_check.hpp"
#include "check/obstruction.hpp"
#include "flight/flight_set.hpp"
#include "report/report.hpp"

namespace photonav {

/// What was checked, and what came out.
struct CheckReport {
    const Config& config;
    World world;
    GivenTrajectory trajectory;
    std::string file;  ///< of the trajectory
    double tilt = 0.;  ///< of the body, at most [rad]
    Obstruction obstruction = {};
    CheckedTrajectory checked = {};
    std::optional<CheckedTrajectory> turned = {};  ///< with the best headings
    EvaluatedPath path = {};                       ///< of `checked`
    FlightSet flights = {};
    bool interrupted = false;
};

/// A checked trajectory as a path that can be drawn.
EvaluatedPath pathOf(const CheckedTrajectory& checked, const std::string& name);

/// "keeps the camera localised", or where it is lost and why.
std::string verdictOf(const CheckedTrajectory& checked);

/// The summary, for the terminal and the page.
ReportTable summaryOf(const CheckReport& report);

/// result.json of `photonav check`; seconds are the caller's to fill.
nlohmann::json checkResult(const CheckReport& report);

/// Writes config.yaml, path.tum, the figures of checkFigures(), report.json and report.html.
void writeCheckReport(const std::filesystem::path& folder, const CheckReport& report,
                      const std::string& commandLine, const nlohmann::json& result);

}  // namespace photonav
