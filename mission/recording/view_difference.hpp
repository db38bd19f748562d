// SPDX-License-Identifier: BSD-3-Clause
// Measures how well a map predicts the images from which it was made.
#pragma once

#include <optional>

#include "alignment/normal_equations.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Differences between a predicted and an observed view, over the pixels at which the map has a
/// surface (for depth: and at which depth was observed).
struct ViewDifference {
    // The first three values are missing if the map predicts no pixel.
    std::optional<double> meanIntensity;    ///< mean absolute difference, grey values in [0, 1]
    std::optional<double> medianIntensity;  ///< median absolute difference, grey values in [0, 1]
    /// Mean absolute deviation of the observed image from its median over these pixels: the
    /// meanIntensity of the best uniform grey image.
    std::optional<double> contrast;
    std::optional<double> meanDepth;    ///< mean absolute difference [m]; none without depth
    std::optional<double> medianDepth;  ///< median absolute difference [m]; none without depth
    double predicted = 0.;              ///< share of all pixels at which the map has a surface
};

/// Applies gain and offset of an observed image to a predicted one, before the two are compared.
void expose(ImageF& predicted, const Exposure& exposure);

/// @throws std::invalid_argument unless both views have the same size
ViewDifference compareViews(const View& observed, const View& predicted);

}  // namespace photonav
