// SPDX-License-Identifier: BSD-3-Clause
// Planning problems and their paths from above.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figures/top_view.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {

/// The bounds from above, grown by the robot's radius [m].
Eigen::AlignedBox2d areaOf(const Config& config);

/// A path to be drawn, with its beliefs.
DrawnPath drawnPath(const EvaluatedPath& path, const Pose& T_b_c);

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
