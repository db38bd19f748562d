// SPDX-License-Identifier: BSD-3-Clause
// result.json of a study of servoing.
#pragma once

#include <nlohmann/json.hpp>

#include "servo/servo_study.hpp"

namespace photonav {

/// Everything of result.json but the time.
nlohmann::json servoResult(const ServoGoal& goal, const ServoStudyOptions& options,
                           const ServoStudy& study);

}  // namespace photonav
