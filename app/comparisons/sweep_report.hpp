// SPDX-License-Identifier: BSD-3-Clause
// The results of a sweep: numbers, tables, figures, page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sweep/sweep_summary.hpp"

namespace photonav {

/// The outcome of a sweep, of one run or merged from shards.
struct SweepOutcome {
    std::string name;  ///< of the config
    std::string commandLine;
    Shard shard;
    std::vector<SweepRun> runs;  ///< in the order of sweepItems()
    std::size_t asked = 0;       ///< runs there should be
    bool interrupted = false;
    double seconds = 0.;  ///< since the command was started
};

/// result.json of `photonav sweep`.
nlohmann::json sweepResult(const Config& config, const SweepOutcome& outcome,
                           const ReferenceCosts& reference);

/// Writes config.yaml, runs.csv, summary.csv, sweep.png, pareto.png, paths.png, report.json,
/// report.html and at last result.json.
void writeSweepReport(const std::filesystem::path& folder, const Config& config, const World& world,
                      const SweepOutcome& outcome, const ReferenceCosts& reference,
                      const nlohmann::json& result);

/// The table as text for a terminal; traces with at least two digits of the smallest mean [m^2].
std::string sweepTable(const std::vector<SweepCell>& cells);

}  // namespace photonav
