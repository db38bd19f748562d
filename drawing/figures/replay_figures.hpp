// SPDX-License-Identifier: BSD-3-Clause
// Results of a replay.
#pragma once

#include <string>
#include <vector>

#include "plot/figure.hpp"
#include "replay/replay_result.hpp"

namespace photonav {

/// Errors of position and orientation over time with the predicted bands of one and three standard
/// deviations, and below them the squared normalised error; grey where tracking was lost. Without
/// ground truth the bands alone.
Figure replayErrorsFigure(const std::string& title, const ReplayRun& run,
                          const ReplayErrors& errors);

/// Observed, predicted and difference of the samples among the strips, one below the other.
/// @throws std::invalid_argument without any
Figure stripsFigure(const std::vector<ReplayStrip>& strips);

/// The same of one.
Figure stripFigure(const ReplayStrip& strip);

}  // namespace photonav
