// SPDX-License-Identifier: BSD-3-Clause
// Figures of a checked trajectory.
#pragma once

#include "check/localisation_check.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Standard deviations of position and rotation along their weakest directions, over the length of
/// the trajectory. Stretches are shaded where images leave directions open or are rejected, or
/// where the camera is lost.
Figure sigmaFigure(const CheckedTrajectory& checked);

/// Weighted trace after one view over distance and heading, with the heading of the trajectory and
/// the best heading.
/// @param checked must contain a comparison of headings (CheckOptions::headings)
Figure headingsFigure(const CheckedTrajectory& checked);

/// Stretches of the trajectory on which the camera is lost, as lines between body positions.
DrawnTree lostStretches(const CheckedTrajectory& checked);

/// Lines from places into the direction of the best heading, where this heading reduces the trace
/// by more than a tenth.
/// @param length length of a line [m]
DrawnTree betterHeadings(const CheckedTrajectory& checked, double length);

}  // namespace photonav
