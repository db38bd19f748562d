// SPDX-License-Identifier: BSD-3-Clause
// The outcome of a sweep, and its result files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

/// "done", "no path" or "interrupted".
std::string sweepStatus(const std::vector<SweepRun>& runs, bool interrupted);

/// Decimals of traces in the table: two digits of the smallest one, four at least.
int traceDecimals(const std::vector<SweepCell>& cells);

/// runs.csv and summary.csv.
/// @param result of sweepResult()
void writeSweepTables(const std::filesystem::path& folder, const nlohmann::json& result,
                      const ReferenceCosts& reference);

}  // namespace photonav
