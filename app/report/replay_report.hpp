// SPDX-License-Identifier: BSD-3-Clause
// The page of a replay.
#pragma once

#include "commands/replay_command.hpp"
#include "runs/replay_result.hpp"

namespace photonav {

/// The main numbers of result.json, with labels.
ReportTable replaySummary(const nlohmann::json& result);

/// Writes config.yaml, errors.png, strips.png, top_view.png, report.json and report.html.
/// @param config as YAML, complete
/// @param describeMap puts the map into the report's 3-D view
void writeReplayReport(const ReplayOptions& options, const std::string& config,
                       const nlohmann::json& result, const ReplaySource& source,
                       const ReplayRun& run, const ReplayErrors& errors,
                       const std::function<void(ReportData&)>& describeMap);

}  // namespace photonav
