// SPDX-License-Identifier: BSD-3-Clause
// Figures of a study of photometric servoing.
#pragma once

#include "plot/figure.hpp"
#include "servo/servo_study.hpp"

namespace photonav {

/// The basin of convergence: share of trials that converge over the distance of the start, one
/// curve per angle, with 95 % intervals.
Figure servoBasinFigure(const ServoStudyOptions& options, const ServoStudy& study);

/// Predicted and simulated decay rates of the modes.
Figure servoModesFigure(const ServoStudy& study);

}  // namespace photonav
