// SPDX-License-Identifier: BSD-3-Clause
// What the pages about a planning problem share.
#pragma once

#include "figures/problem_view.hpp"
#include "report/report.hpp"

namespace photonav {

/// Puts the surfaces of the world into the report's 3-D view.
void describeWorld(const World& world, ReportData& report);

/// The page of a planning problem, without a title: config, world, camera, start and goal.
ReportData problemReport(const Config& config, const World& world, const std::string& commandLine,
                         const nlohmann::json& result);

/// Views from points of the first path, with the contributions of their pixels.
/// @param points indices
std::vector<ReportView> reportViews(const Config& config, const World& world,
                                    const EvaluatedPath& path,
                                    const std::vector<std::size_t>& points);

}  // namespace photonav
