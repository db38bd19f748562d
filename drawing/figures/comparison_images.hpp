// SPDX-License-Identifier: BSD-3-Clause
// Observed and predicted views side by side.
#pragma once

#include <string>
#include <vector>

#include "figures/images.hpp"
#include "recording/recorded_frames.hpp"

namespace photonav {

/// Observed image, predicted image and their absolute difference.
/// @param caption caption of the observed image
/// @throws std::invalid_argument unless both views have the same size
std::vector<CaptionedImage> comparisonImages(const View& observed, const View& predicted,
                                             const std::string& caption);

/// One row per waypoint: the view predicted at the waypoint, the nearest recorded frame, its
/// prediction, and the difference of these two.
/// @throws std::invalid_argument for a comparison without frames
Figure recordedFramesFigure(const RecordedComparison& comparison);

}  // namespace photonav
