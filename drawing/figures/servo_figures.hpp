// SPDX-License-Identifier: BSD-3-Clause
// Figures of a study of servoing.
#pragma once

#include "plot/figure.hpp"
#include "servo/servo_study.hpp"

namespace photonav {

/// The share of starts that converge over their distance, a curve an angle.
Figure servoBasinFigure(const ServoStudyOptions& options, const ServoStudy& study);

/// Rates of the modes, predicted and simulated.
Figure servoModesFigure(const ServoStudy& study);

}  // namespace photonav
