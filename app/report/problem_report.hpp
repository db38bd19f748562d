// SPDX-License-Identifier: BSD-3-Clause
// What the reports about a planning problem share: the page, paths, pictures from above.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "figures/top_view.hpp"
#include "problem/planning_problem.hpp"
#include "report/report.hpp"

namespace photonav {

/// The bounds from above, grown by the robot's radius [m].
Eigen::AlignedBox2d areaOf(const Config& config);

/// A path to be drawn, with its beliefs.
DrawnPath drawnPath(const EvaluatedPath& path, const Pose& T_b_c);

/// Puts the surfaces of the world into the report's 3-D view.
void describeWorld(const World& world, ReportData& report);

/// The page of a planning problem, without a title: config, world, start and goal.
ReportData problemReport(const Config& config, const World& world, const std::string& commandLine,
                         const nlohmann::json& result);

/// Start, goal and paths over what lies below the bounds.
TopView viewFromAbove(const Config& config, const World& world,
                      const std::vector<DrawnPath>& paths);

/// Where the views of a heat map are: the height, and the heading [rad] where it is free.
std::string placeText(const Config& config, double height, double yaw);

/// A value of the view from every cell of a horizontal grid; NaN where the robot cannot be.
/// @param cells about how many along the longer side
/// @param value of the view's Fisher information (camera frame)
Eigen::ArrayXXd viewGrid(PlanningProblem& problem, const Eigen::AlignedBox2d& area, double height,
                         double yaw, int cells, const std::function<double(const Matrix6&)>& value);

}  // namespace photonav
