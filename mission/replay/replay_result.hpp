// SPDX-License-Identifier: BSD-3-Clause
// The result of a replay, in numbers and words.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "replay/replay_errors.hpp"

namespace photonav {

using TimeInterval = std::pair<double, double>;  ///< [s]
std::vector<TimeInterval> lostIntervals(const ReplayRun& run);

/// Pauses of more than three times the usual interval between frames.
std::vector<TimeInterval> gaps(const Sequence& sequence);

/// The run in one sentence, with what may be wrong when it was lost.
std::string verdictOf(const ReplayRun& run);

/// Whether it ended without a believed pose of the camera.
bool isLostForGood(const ReplayRun& run);

/// The numbers of result.json: frames, errors, NEES and speed.
nlohmann::json replayResult(const Sequence& sequence, const ReplayRun& run,
                            const ReplayErrors& errors);

}  // namespace photonav
