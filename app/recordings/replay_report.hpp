// SPDX-License-Identifier: BSD-3-Clause
// The report of a replay.
#pragma once

#include "recordings/replay_command.hpp"
#include "replay/replay.hpp"
#include "replay/replay_result.hpp"

namespace photonav {

/// The main numbers of result.json, with labels.
ReportTable replaySummary(const nlohmann::json& result);

/// Writes config.yaml, errors.png, strips.png, top_view.png, report.json and report.html.
/// @param config complete config as YAML
void writeReplayReport(const std::filesystem::path& folder, const ReplayCommandOptions& options,
                       const std::string& config, const nlohmann::json& result,
                       const Replay& replay, const ReplayRun& run, const ReplayErrors& errors);

}  // namespace photonav
