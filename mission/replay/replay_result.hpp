// SPDX-License-Identifier: BSD-3-Clause
// The result of a replay: summary sentence, time intervals and content of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "replay/replay_errors.hpp"

namespace photonav {

using TimeInterval = std::pair<double, double>;  ///< begin and end [s]

/// Intervals in which tracking was lost: time stamps of the first and last lost frame.
std::vector<TimeInterval> lostIntervals(const ReplayRun& run);

/// Gaps between consecutive frames that are longer than three times the median interval.
std::vector<TimeInterval> gaps(const Sequence& sequence);

/// The result of the run in one sentence, with a possible cause if tracking was lost.
std::string verdictOf(const ReplayRun& run);

/// Whether tracking was lost at the last readable frame. A run without readable frames counts as
/// lost, unless it was interrupted.
bool isLostForGood(const ReplayRun& run);

/// The numbers of result.json: frames, errors, NEES and frames per second.
nlohmann::json replayResult(const Sequence& sequence, const ReplayRun& run,
                            const ReplayErrors& errors);

}  // namespace photonav
