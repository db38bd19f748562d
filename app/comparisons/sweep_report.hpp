// SPDX-License-Identifier: BSD-3-Clause
// Writes the result files of a sweep: tables, figures and page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sweep/sweep_result.hpp"

namespace photonav {

/// Writes config.yaml, runs.csv, summary.csv, sweep.png, pareto.png, paths.png, report.json and
/// report.html.
/// @param reference best known costs, for the column of the excess; may be empty
/// @param result content of result.json
void writeSweepReport(const std::filesystem::path& folder, const Config& config, const World& world,
                      const SweepOutcome& outcome, const ReferenceCosts& reference,
                      const nlohmann::json& result);

/// The summary of a sweep as text for a terminal, one table per planner. Traces [m^2] have at least
/// two digits of the smallest mean.
std::string sweepTable(const std::vector<SweepCell>& cells);

}  // namespace photonav
