// SPDX-License-Identifier: BSD-3-Clause
// Views of planning problems and their paths from above.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figures/top_view.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {

/// The bounds of the config in x and y, enlarged by the robot's radius [m].
Eigen::AlignedBox2d areaOf(const Config& config);

/// A path with its beliefs, for drawing.
/// @param T_b_c camera mount
DrawnPath drawnPath(const EvaluatedPath& path, const Pose& T_b_c);

/// Start, goal and paths over a picture of the surfaces below the top of the bounds. In spaces with
/// a heading, wedges show where the camera looks.
TopView viewFromAbove(const Config& config, const World& world,
                      const std::vector<DrawnPath>& paths);

/// The poses of a heat map's views in words: their height [m] and, unless the space is xyz, their
/// heading, "1.20 m, heading 90 deg".
/// @param yaw heading [rad]
std::string placeText(const Config& config, double height, double yaw);

/// A value of the view from each cell of a horizontal grid; NaN where the robot cannot be. (i, j)
/// is the i-th cell along x and the j-th along y.
/// @param area the area of all cells, x and y [m]
/// @param height of the body [m]
/// @param yaw heading of the body [rad]
/// @param cells number of cells along the longer side
/// @param value computes the value from the view's Fisher information (camera frame)
/// @param onProgress called after every row along y with the share done, in (0, 1]
Eigen::ArrayXXd viewGrid(PlanningProblem& problem, const Eigen::AlignedBox2d& area, double height,
                         double yaw, int cells, const std::function<double(const Matrix6&)>& value,
                         const std::function<void(double)>& onProgress = {});

}  // namespace photonav
