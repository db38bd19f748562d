// SPDX-License-Identifier: BSD-3-Clause
// What factor and floor would have made the covariances of a replay true.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimation/calibration.hpp"
#include "replay/replay_run.hpp"

namespace photonav {

constexpr std::size_t kLeastForCalibration = 20;  ///< alignments

/// The errors of the alignments that converged, of images whose true pose is known: in the map, or
/// relative to the keyframe aligned to.
std::vector<AlignmentError> alignmentErrors(const ReplayRun& run);

/// Nothing when there are too few of them.
/// @param floorOnly keep the factor: for maps of cells
std::optional<Calibration> calibrationOf(const ReplayRun& run, bool floorOnly);

/// For the command line, and as YAML that readCalibration() reads back.
std::string toYaml(const Calibration& calibration, bool odometry);

/// Factor, floor and correlation time of such a file.
/// @throws InputError naming file, key and reason, also for a file of the other mode
Calibration readCalibration(const std::string& file, bool odometry);

}  // namespace photonav
