// SPDX-License-Identifier: BSD-3-Clause
// The results of a sweep: numbers, tables, figures, page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sweep/sweep_result.hpp"

namespace photonav {

/// Writes config.yaml, runs.csv, summary.csv, sweep.png, pareto.png, paths.png, report.json,
/// report.html.
void writeSweepReport(const std::filesystem::path& folder, const Config& config, const World& world,
                      const SweepOutcome& outcome, const ReferenceCosts& reference,
                      const nlohmann::json& result);

/// The table as text for a terminal; traces with at least two digits of the smallest mean [m^2].
std::string sweepTable(const std::vector<SweepCell>& cells);

}  // namespace photonav
