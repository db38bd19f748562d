// SPDX-License-Identifier: BSD-3-Clause
// Figures of a checked trajectory.
#pragma once

#include "check/localisation_check.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Standard deviations of position and rotation along the trajectory, above places where images
/// leave directions open, are rejected, or the camera is lost.
Figure sigmaFigure(const CheckedTrajectory& checked);

/// Trace after one view, by distance and heading, with the trajectory's heading and the best one.
/// @param checked with headings compared
Figure headingsFigure(const CheckedTrajectory& checked);

/// Stretches on which the camera is lost, as lines from above.
DrawnTree lostStretches(const CheckedTrajectory& checked);

/// Short lines from the places into the best heading, where it gains a tenth of the trace.
/// @param length of a line [m]
DrawnTree betterHeadings(const CheckedTrajectory& checked, double length);

}  // namespace photonav
