// SPDX-License-Identifier: BSD-3-Clause
// Values over a horizontal area.
#pragma once

#include <string>

#include "plot/figure.hpp"

namespace photonav {

/// A value per cell of a horizontal grid, for example the information of a view there.
struct HeatMap {
    std::string title = {};
    std::string label = {};         ///< quantity and unit, beside the colour bar
    Eigen::AlignedBox2d area = {};  ///< that the cells fill, x and y in w [m]
    Eigen::ArrayXXd values = {};    ///< (i, j): i-th cell along x, j-th along y, both from the
                                    ///< smallest; not finite: not flyable, drawn hatched
    bool logScale = false;          ///< values <= 0 are drawn in dark grey
};

/// @throws std::invalid_argument if the area or the grid is empty
Figure heatMapFigure(const HeatMap& map);

}  // namespace photonav
