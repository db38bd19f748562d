// SPDX-License-Identifier: BSD-3-Clause
// The calibration of a tracker as a file, which a replay writes and replays and flights read.
#pragma once

#include <string>

#include "estimation/calibration.hpp"

namespace photonav {

/// For the command line, and as YAML that readCalibration() reads back.
std::string toYaml(const Calibration& calibration, bool odometry);

/// Factor, floor and correlation time of such a file.
/// @throws InputError naming file, key and reason, also for a file of the other mode
Calibration readCalibration(const std::string& file, bool odometry);

}  // namespace photonav
