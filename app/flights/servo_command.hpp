// SPDX-License-Identifier: BSD-3-Clause
// `photonav servo`: photometric visual servoing at a goal.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "config/config.hpp"
#include "servo/servo_study.hpp"
#include "shared/command_io.hpp"

namespace photonav {

struct ServoOptions : CommandOptions {
    std::optional<std::string> at;         ///< x,y,z[,yaw] of the goal; default: the config's
    std::optional<std::string> distances;  ///< "a,b,c" [m]
    std::optional<std::string> angles;     ///< "a,b,c" [degrees]
    ServoStudyOptions study;
};

/// The study with the lists that were typed and the seed of the config.
/// @throws InputError for bad input
ServoStudyOptions studyOf(const ServoOptions& options, const Config& config);

/// From how far a servo on the goal's grey values converges, how fast, and in which direction
/// slowest. Writes result.json, config.yaml, basin.png, modes.png, goal.png, report.json and
/// report.html.
/// @return the exit code: 1 when the goal's view leaves a direction open
/// @throws InputError for bad input, before anything is written
int runServo(const ServoOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
