// SPDX-License-Identifier: BSD-3-Clause
// Errors of a replay with respect to ground truth.
#pragma once

#include <optional>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "replay/replay_run.hpp"

namespace photonav {

/// A tracked frame with ground truth.
struct EvaluatedFrame {
    std::size_t frame = 0;  ///< index into ReplayRun::frames
    PosePair pair;
    double positionError = 0.;  ///< distance of the camera centres, without alignment [m]
    double rotationError = 0.;  ///< angle between the orientations, without alignment [rad]
    double positionSigma = 0.;  ///< square root of the trace of the position covariance [m]
    double rotationSigma = 0.;  ///< square root of the trace of the rotation covariance [rad]
    /// NEES. None for odometry whose first image has no true pose: its covariance is zero at the
    /// first image, but its error is zero at the later frame of alignToTruth().
    std::optional<NormalisedError> normalised;
};

/// Errors of a run. The absolute errors of odometry are computed after a rigid alignment of the
/// trajectory to the ground truth; relative errors and NEES are computed without it.
struct ReplayErrors {
    std::vector<EvaluatedFrame> frames;
    /// Absolute trajectory error, and relative errors over 1 frame, 1 s and 1 m.
    PoseErrors absolute, perFrame, perSecond, perMetre;
};
/// Computes the errors of all tracked frames with ground truth.
ReplayErrors evaluate(const ReplayRun& run);

}  // namespace photonav
