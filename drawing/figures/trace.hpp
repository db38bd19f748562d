// SPDX-License-Identifier: BSD-3-Clause
// Uncertainty along paths.
#pragma once

#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Trace of the pose covariance over the distance along each path.
/// @param logScale decades instead of a linear axis from 0
Figure traceFigure(const std::string& title, const std::vector<DrawnPath>& paths, bool logScale);

}  // namespace photonav
