// SPDX-License-Identifier: BSD-3-Clause
// A replay against the true poses.
#pragma once

#include <optional>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "replay/replay_run.hpp"

namespace photonav {

/// A tracked frame whose true pose is known.
struct EvaluatedFrame {
    std::size_t frame = 0;  ///< index into ReplayRun::frames
    PosePair pair;
    double positionError = 0.;  ///< distance of the camera centres, not aligned [m]
    double rotationError = 0.;  ///< [rad]
    double positionSigma = 0.;  ///< root of the trace of the position's covariance [m]
    double rotationSigma = 0.;  ///< the same of the rotation's [rad]
    /// None where odometry did not begin at a true pose: what its errors are relative to is not
    /// where its covariances began.
    std::optional<NormalisedError> normalised;
};

/// Errors of a run. Odometry is evaluated after a rigid alignment of its positions to the true ones
/// (absolute errors only; relative ones need none, NEES is of the belief as it is).
struct ReplayErrors {
    std::vector<EvaluatedFrame> frames;
    PoseErrors absolute, perFrame, perSecond, perMetre;
};
ReplayErrors evaluate(const ReplayRun& run);

}  // namespace photonav
