// SPDX-License-Identifier: BSD-3-Clause
// Figures of the uncertainty along paths.
#pragma once

#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Weighted trace of the pose covariance [m^2] over the distance along each path.
/// @param logScale true: logarithmic axis; false: linear axis from 0
Figure traceFigure(const std::string& title, const std::vector<DrawnPath>& paths, bool logScale);

}  // namespace photonav
