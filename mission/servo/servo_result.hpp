// SPDX-License-Identifier: BSD-3-Clause
// result.json of a study of photometric servoing.
#pragma once

#include <nlohmann/json.hpp>

#include "servo/servo_study.hpp"

namespace photonav {

/// Parameters of the control law, rate and width of its images.
nlohmann::json servoOptionsJson(const ServoStudyOptions& options, const Camera& camera);

/// The results of the study: condition number, standard deviations, modes and basin of convergence.
nlohmann::json servoStudyJson(const ServoStudy& study);

/// The content of result.json without the computation time.
nlohmann::json servoResult(const ServoGoal& goal, const ServoStudyOptions& options,
                           const ServoStudy& study);

}  // namespace photonav
