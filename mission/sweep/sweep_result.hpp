// SPDX-License-Identifier: BSD-3-Clause
// The outcome of a sweep, and its result files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sweep/sweep_summary.hpp"

namespace photonav {

/// The outcome of a sweep: of one call of the command, or merged from its shards.
struct SweepOutcome {
    std::string name;  ///< name of the config
    std::string commandLine;
    Shard shard;
    std::vector<SweepRun> runs;  ///< finished runs, in the order of sweepItems()
    std::size_t asked = 0;       ///< number of runs of the complete sweep or shard
    bool interrupted = false;
    double seconds = 0.;  ///< wall-clock time since the command was started [s]
};

/// The content of result.json of `photonav sweep`.
nlohmann::json sweepResult(const Config& config, const SweepOutcome& outcome,
                           const ReferenceCosts& reference);

/// "interrupted", else "done" if any run found a path, else "no path".
std::string sweepStatus(const std::vector<SweepRun>& runs, bool interrupted);

/// Number of decimals for traces in the table: enough for two digits of the smallest mean trace,
/// and at least four.
int traceDecimals(const std::vector<SweepCell>& cells);

/// Writes runs.csv and summary.csv into a folder.
/// @param result returned by sweepResult()
void writeSweepTables(const std::filesystem::path& folder, const nlohmann::json& result,
                      const ReferenceCosts& reference);

}  // namespace photonav
