// SPDX-License-Identifier: BSD-3-Clause
// What a replay amounts to in numbers, and the tables of it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "recording/belief_trajectory.hpp"
#include "runs/replay_run.hpp"

namespace photonav {

/// A tracked frame whose true pose is known.
struct JudgedFrame {
    std::size_t frame = 0;  ///< index into ReplayRun::frames
    PosePair pair;
    double positionError = 0.;  ///< distance of the camera centres, not aligned [m]
    double rotationError = 0.;  ///< [rad]
    double positionSigma = 0.;  ///< root of the trace of the position's covariance [m]
    double rotationSigma = 0.;  ///< the same of the rotation's [rad]
    /// Per degree of freedom. None where odometry did not begin at a true pose: what its errors
    /// are relative to is not where its covariances began.
    std::optional<double> nees;
};

/// Errors of a run. Odometry is judged after a rigid alignment of its positions to the true ones
/// (absolute errors only; relative ones need none, NEES is of the belief as it is).
struct ReplayErrors {
    std::vector<JudgedFrame> judged;
    PoseErrors absolute, perFrame, perSecond, perMetre;
};
ReplayErrors judge(const ReplayRun& run, bool odometry);

using TimeInterval = std::pair<double, double>;  ///< [s]
std::vector<TimeInterval> lostIntervals(const ReplayRun& run);

/// Pauses of more than three times the usual interval between frames.
std::vector<TimeInterval> gaps(const ReplaySource& source);

/// The run in one sentence, with what may be wrong when it was lost.
/// @param inMap localised in a map, not by odometry
std::string verdictOf(const ReplayRun& run, bool inMap);

/// Whether it ended without knowing where the camera is.
bool isLostForGood(const ReplayRun& run);

std::vector<StampedBelief> beliefsOf(const ReplayRun& run);  ///< of the frames tracked

/// result.json but for what only the command knows.
nlohmann::json replayResult(const ReplaySource& source, const ReplayRun& run,
                            const ReplayErrors& errors, bool aligned);

/// Writes frames.csv (a row per frame), trajectory.tum, .cov and .ov of the frames tracked, and
/// groundtruth.tum of the frames used, in the same world and of the same camera.
void writeReplayTables(const std::filesystem::path& folder, const ReplayRun& run,
                       const ReplayErrors& errors);

}  // namespace photonav
