// SPDX-License-Identifier: BSD-3-Clause
// Estimates the point spread of a recording's images from a replay in a mesh.
#pragma once

#include <optional>

#include "replay/replay_run.hpp"

namespace photonav {

/// Point spread of recorded images, in pixels of the recording.
struct BlurEstimate {
    double blur = 0.;      ///< standard deviation [pixels]
    double variance = 0.;  ///< its square; negative for images sharper than views can be [pixels^2]
    /// Standard deviation of the variance: scatter over the images, and what rendered views get
    /// wrong (kBlurError) [pixels^2].
    double sigma = 0.;

    /// Whether the images contradict a point spread by more than two standard deviations.
    bool contradicts(double assumedBlur) const;
};

/// The median over the images that converged. Views of a mesh have a known point spread, so that
/// the residuals show the images' blur. In a map of cells they do not: its texture is as blurred
/// as the images that it was made of.
/// @param run a replay in a mesh
/// @return nothing for fewer than five images whose texture shows it
std::optional<BlurEstimate> estimateBlur(const ReplayRun& run);

}  // namespace photonav
