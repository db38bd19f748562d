// SPDX-License-Identifier: BSD-3-Clause
// What scale and least sigmas would have made the covariances of a replay true.
#pragma once

#include <optional>
#include <vector>

#include "estimation/calibration.hpp"
#include "replay/replay_run.hpp"

namespace photonav {

constexpr std::size_t kLeastForCalibration = 20;  ///< alignments

/// The errors of the alignments that converged, of images whose true pose is known: in the map, or
/// relative to the keyframe aligned to.
std::vector<AlignmentError> alignmentErrors(const ReplayRun& run);

/// Nothing when there are too few of them.
/// @param leastSigmaOnly keep the factor: for maps of cells
std::optional<Calibration> calibrationOf(const ReplayRun& run, bool leastSigmaOnly);

}  // namespace photonav
