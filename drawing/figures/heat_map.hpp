// SPDX-License-Identifier: BSD-3-Clause
// Heat maps of values over a horizontal area.
#pragma once

#include <string>

#include "plot/figure.hpp"

namespace photonav {

/// A value per cell of a horizontal grid, for example the information of a view there.
struct HeatMap {
    std::string title = {};
    std::string label = {};         ///< quantity and unit, for the colour bar
    Eigen::AlignedBox2d area = {};  ///< the area of all cells, x and y in the world frame [m]
    Eigen::ArrayXXd values = {};  ///< (i, j): i-th cell along x and j-th along y, in rising order;
                                  ///< not finite: not flyable, drawn hatched
    bool logScale = false;        ///< logarithmic colours; values <= 0 are drawn in dark grey
};

/// A figure of the heat map with a colour bar.
/// @throws std::invalid_argument if the area or the grid is empty
Figure heatMapFigure(const HeatMap& map);

}  // namespace photonav
