// SPDX-License-Identifier: BSD-3-Clause
// Calibrates the covariances of alignments, by scale and least sigmas, and the error of depth, from
// a replay with ground truth.
#pragma once

#include <optional>
#include <vector>

#include "estimation/calibration.hpp"
#include "replay/replay_run.hpp"

namespace photonav {

constexpr std::size_t kLeastForCalibration = 20;  ///< least number of alignment errors

/// The errors of all converged alignments of images with ground truth: of the pose in the map, or,
/// for odometry, of the pose relative to the keyframe.
std::vector<AlignmentError> alignmentErrors(const ReplayRun& run);

/// The calibration by these errors; nothing if there are fewer than kLeastForCalibration.
/// @param leastSigmaOnly true: only the least sigmas are estimated, and the scale of the run is
///        kept, as is right for maps of cells (calibrateLeastSigma())
std::optional<Calibration> calibrationOf(const ReplayRun& run, bool leastSigmaOnly);

/// The depth error by these errors, see calibrateDepthError(); nothing in a map, and if there are
/// fewer than kLeastForCalibration.
/// @param counted Replay::depthError()
std::optional<double> depthErrorOf(const ReplayRun& run, double counted);

}  // namespace photonav
