// SPDX-License-Identifier: BSD-3-Clause
// `photonav servo`: studies photometric visual servoing at a goal.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "config/config.hpp"
#include "servo/servo_study.hpp"
#include "shared/command_io.hpp"

namespace photonav {

struct ServoOptions : CommandOptions {
    std::optional<std::string> at;         ///< goal, "x,y,z[,yaw]" [m, rad]; none: the config's
    std::optional<std::string> distances;  ///< "a,b,c" [m]; none: the distances of `study`
    std::optional<std::string> angles;     ///< "a,b,c" [degrees]; none: the angles of `study`
    ServoStudyOptions study;
};

/// ServoOptions::study with the given distances and angles and the seed of the config.
/// @throws InputError for a list with bad numbers, and for a gain above the image rate
ServoStudyOptions studyOf(const ServoOptions& options, const Config& config);

/// Studies the basin of convergence, the rate of convergence and its slowest direction, for
/// servoing on the grey values of the goal's view. Images have half the camera's width and height.
/// Writes result.json, config.yaml, basin.png, modes.png, goal.png, report.json and report.html.
/// @param interrupted when set, the results contain the trials so far (exit code 130)
/// @return the exit code: kNoAnswer if the view at the goal leaves a direction open
/// @throws InputError for bad input, before anything is written
int runServo(const ServoOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
