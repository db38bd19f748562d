// SPDX-License-Identifier: BSD-3-Clause
// Paths, their uncertainty and trees from above.
#pragma once

#include <string>
#include <vector>

#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Start, goal, paths and trees over the grey values of the floor or map.
struct TopView {
    std::string title = {};
    Eigen::AlignedBox2d area = {};  ///< what is drawn, x and y in w [m]
    ImageF background = {};  ///< grey values in [0, 1] over `area`: first row at the largest y,
                             ///< first column at the smallest x; may be empty
    std::vector<DrawnTree> trees = {};
    std::vector<DrawnPath> paths = {};  ///< the first one is drawn on top, of those that run
                                        ///< along it the lower ones wider
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();  ///< in w
    std::string goalName = "goal";
    double ellipseScale = 1.0;  ///< ellipses of 3 standard deviations of the position are drawn
                                ///< this much larger (the legend states it); 0: none
};

/// An ellipseScale of 1, 2, 5, 10, 20, ... with which the largest ellipse of the paths is as large
/// as it can be without reaching farther than a twentieth of a side [m]; 1 for larger ones.
double readableEllipseScale(const std::vector<DrawnPath>& paths, double side);

/// The map alone, for figures of several panels.
/// @param side the longer one [px]
/// @throws std::invalid_argument if the area is empty
Plot topViewPlot(const TopView& view, double side);

/// @throws std::invalid_argument if the area is empty
Figure topViewFigure(const TopView& view);

/// Small maps without ellipses and legend, in rows.
/// @throws std::invalid_argument if there is none, or an area is empty
Figure mapsFigure(const std::vector<std::vector<TopView>>& rows);

}  // namespace photonav
