// SPDX-License-Identifier: BSD-3-Clause
// Views of paths, their uncertainty and trees from above.
#pragma once

#include <string>
#include <vector>

#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Start, goal, paths and trees over a grey picture of the scene or map.
struct TopView {
    std::string title = {};
    Eigen::AlignedBox2d area = {};  ///< area of the picture, x and y in the world frame [m]
    ImageF background = {};  ///< grey values in [0, 1] over `area`: first row at the largest y,
                             ///< first column at the smallest x; may be empty
    std::vector<DrawnTree> trees = {};
    std::vector<DrawnPath> paths = {};  ///< the first path is drawn on top; paths that run along a
                                        ///< path above them are drawn wider
    Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< world frame [m]
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();   ///< world frame [m]
    std::string goalName = "goal";
    double ellipseScale = 1.0;   ///< factor on the 3-sigma ellipses of the position, stated in the
                                 ///< legend; 0: no ellipses
    double horizontalFov = 0.0;  ///< full angle of the wedges that show where cameras along the
                                 ///< paths look [rad]; 0: no wedges
};

/// The largest ellipseScale of 1, 2, 5, 10, 20, ... for which the half axis of the largest 3-sigma
/// ellipse is at most a twentieth of the picture's side; at least 1.
/// @param side longer side of the picture [m]
double readableEllipseScale(const std::vector<DrawnPath>& paths, double side);

/// The plot of a view from above, for figures with several panels.
/// @param side longer side of the plot [px]
/// @throws std::invalid_argument if the area is empty
Plot topViewPlot(const TopView& view, double side);

/// A figure of one view from above, with legend.
/// @throws std::invalid_argument if the area is empty
Figure topViewFigure(const TopView& view);

/// A figure of small views from above in rows, without ellipses, wedges and legend.
/// @throws std::invalid_argument if there is no view, or an area is empty
Figure mapsFigure(const std::vector<std::vector<TopView>>& rows);

}  // namespace photonav
