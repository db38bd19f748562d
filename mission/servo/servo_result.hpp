// SPDX-License-Identifier: BSD-3-Clause
// result.json of a study of servoing.
#pragma once

#include <nlohmann/json.hpp>

#include "servo/servo_study.hpp"

namespace photonav {

/// The law and its images.
nlohmann::json servoOptionsJson(const ServoStudyOptions& options, const Camera& camera);

/// What was found: condition, standard deviations, modes and basin.
nlohmann::json servoStudyJson(const ServoStudy& study);

/// Everything of result.json but the time.
nlohmann::json servoResult(const ServoGoal& goal, const ServoStudyOptions& options,
                           const ServoStudy& study);

}  // namespace photonav
