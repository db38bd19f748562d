// SPDX-License-Identifier: BSD-3-Clause
// Figures of a replay.
#pragma once

#include <string>
#include <vector>

#include "plot/figure.hpp"
#include "replay/replay_result.hpp"

namespace photonav {

/// Errors of position and orientation over time, with the predicted bands of one and three standard
/// deviations, and below them the NEES per degree of freedom. Times of lost tracking are grey.
/// Without ground truth only the bands are drawn.
Figure replayErrorsFigure(const std::string& title, const ReplayRun& run,
                          const ReplayErrors& errors);

/// Observed image, predicted image and their difference for the samples (ReplayStrip::isSample),
/// one row each.
/// @throws std::invalid_argument if there is no sample
Figure stripsFigure(const std::vector<ReplayStrip>& strips);

/// Observed image, predicted image and their difference for one strip.
Figure stripFigure(const ReplayStrip& strip);

}  // namespace photonav
