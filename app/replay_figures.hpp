// SPDX-License-Identifier: BSD-3-Clause
// The figures of a replay as PNG pictures.
#pragma once

#include <string>
#include <vector>

#include "pictures.hpp"
#include "replay_result.hpp"

namespace photonav {

/// Errors of position and orientation over time with the predicted bands of one and three standard
/// deviations, and below them the squared normalised error; grey where the camera was lost. Without
/// ground truth the bands alone.
Png drawReplayErrors(const std::string& title, const ReplayRun& run, const ReplayErrors& errors);

/// Observed, predicted and residual of every strip, one below the other. Where nothing is
/// predicted, the picture is blue.
/// @throws std::invalid_argument without strips
Png drawStrips(const std::vector<ReplayStrip>& strips);

}  // namespace photonav
