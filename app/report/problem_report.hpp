// SPDX-License-Identifier: BSD-3-Clause
// Common parts of the reports about planning problems.
#pragma once

#include "figures/problem_view.hpp"
#include "report/report.hpp"

namespace photonav {

/// Adds the surfaces of the scene and the cells of the map to the report's 3-D view.
void describeWorld(const World& world, ReportData& report);

/// The report of a planning problem, without a title: config, world, camera, start and goal.
/// @param commandLine the command as typed
/// @param result content of result.json
ReportData problemReport(const Config& config, const World& world, const std::string& commandLine,
                         const nlohmann::json& result);

/// The predicted views at points of a path, with the contributions of their pixels.
/// @param path the first path of the report
/// @param points indices of the points in the path
std::vector<ReportView> reportViews(const Config& config, const World& world,
                                    const EvaluatedPath& path,
                                    const std::vector<std::size_t>& points);

}  // namespace photonav
