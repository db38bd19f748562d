// SPDX-License-Identifier: BSD-3-Clause
// Observed and predicted views side by side.
#pragma once

#include <string>
#include <vector>

#include "figures/images.hpp"
#include "recording/recorded_frames.hpp"

namespace photonav {

/// Observed, predicted and absolute difference.
/// @param caption of the first image
/// @throws std::invalid_argument unless both views have the same size
std::vector<CaptionedImage> comparisonImages(const View& observed, const View& predicted,
                                             const std::string& caption);

/// Per waypoint: the view predicted there, the frame, its prediction and their difference.
/// @throws std::invalid_argument without frames
Figure recordedFramesFigure(const RecordedComparison& comparison);

}  // namespace photonav
